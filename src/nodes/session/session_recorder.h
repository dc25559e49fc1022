#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>

#include <diagnostic_updater/diagnostic_updater.h>
#include <ros/ros.h>
#include <std_srvs/Trigger.h>

#include "endovascular_sim/AddMark.h"
#include "endovascular_sim/SessionProgress.h"
#include "endovascular_sim/SetSubject.h"
#include "endovascular_sim/SimulationRun.h"
#include "nodes/session/recorded_topics.h"
#include "nodes/session/recording.h"
#include "nodes/session/run_bags.h"
#include "nodes/session/step_sequence.h"
#include "scene/model/scene.h"

namespace endovascular_sim::nodes
{

/** Settings of a recording, from the private parameters of the session node. */
struct RecorderSettings
{
  std::string folder;             ///< folder of all results
  bool stop_at_duration = false;  ///< end at the duration of the scene
  double patience = 60.0;         ///< longest time without a step, with stop_at_duration [s]
  double start_patience = 600.0;  ///< the same before the first step, while the vessel is generated [s]
  int picture_interval = 15;      ///< interval of the fluoroscopy frames that are saved as PNG [frames]; 0: none
  std::string subject;            ///< of session/info
  bool continues = false;         ///< true: the node was started again; its recording continues in a further bag
  std::string run_folder;         ///< folder of the recording that continues
  std::uint32_t run = 0;          ///< number of its run
  bool is_stopped = false;        ///< true: it was stopped by session/stop
};

/** Recorder of a session: records the topics of a scene (RecordedTopics), and writes the report at the end. A reset
 *  and a loaded state begin a further recording, in the subfolder `run_N`, also after the service session/stop. The
 * recording of a run continues in a further bag when the node is started again, and with session/start: the bag begins
 * with the state of the next step, which rod_dynamics gives, and the report of the folder covers all of its bags. */
class SessionRecorder
{
public:
  /** @throws InputError when the folder or a file in it cannot be created */
  SessionRecorder(const ros::NodeHandle& node, scene::Scene scene, RecorderSettings settings);
  ~SessionRecorder();

  /** Ends the session: stops the recording and unsubscribes; further calls have no effect.
   *  @return true when everything of all recordings was written */
  bool finish();

  /** Begins the recording of a new run once that of the last one is complete, and publishes the progress. To be called
   *  often, also without messages. */
  void update();

  /** Reports whether the session has ended by itself. */
  bool isOver() const { return over_; }

private:
  void onRun(const ros::MessageEvent<SimulationRun const>& event);
  void onTimer(const ros::SteadyTimerEvent&);
  bool onStart(std_srvs::Trigger::Request& request, std_srvs::Trigger::Response& response);
  bool onSubject(SetSubject::Request& request, SetSubject::Response& response);
  bool onMark(AddMark::Request& request, AddMark::Response& response);
  bool onStop(std_srvs::Trigger::Request& request, std_srvs::Trigger::Response& response);
  void logProgress();
  void fillDiagnostics(diagnostic_updater::DiagnosticStatusWrapper& status) const;
  void endWith(const std::string& error);
  bool isRecording() const { return !finished_ && !stopped_; }
  std::uint64_t lastStep() const { return recording_ ? recording_->results.report().lastStep() : 0; }
  std::string folderOf(std::uint32_t run) const;
  void open(const std::string& folder, const std::string& bag_name);
  void remember(const std::string& folder);
  void subscribe();
  void tryToContinue();
  void continueRun(const SimulationRun& run, std::uint64_t run_began);
  void addFormerBags(const RunBags& bags, const SimulationRun& run, std::uint64_t run_began);
  void beginRun();
  /** Closes the bag and writes the report; the next run begins a further recording. */
  void stop();
  bool closeRecording();
  void publishVerdict();
  void updateErrors();
  void publishProgress();

  ros::NodeHandle node_;
  scene::Scene scene_;
  RecorderSettings settings_;
  ros::NodeHandle parameters_;            ///< private parameters, which outlive the process
  std::unique_ptr<Recording> recording_;  ///< null while the first one is awaited
  StepSequence sequence_;
  std::uint32_t run_ = 0;       ///< run of the recording; 0 before the first message about it
  SimulationRunConstPtr next_;  ///< run that is to be recorded; null without one
  ros::SteadyTime next_since_;  ///< arrival of next_
  bool awaits_state_ = false;   ///< true: a further bag of the run begins as soon as the graph is connected
  ros::SteadyTime attempted_;   ///< last attempt to begin it
  std::string obstacle_;        ///< reason for which it does not begin; empty without one
  bool over_ = false;           ///< the session has ended by itself
  bool finished_ = false;       ///< the session has ended
  bool stopped_ = false;        ///< the recording is closed, and no further one has begun
  bool complete_ = true;
  double logged_time_ = 0.0;                   ///< simulated time of the last progress message [s]
  ros::SteadyTime diagnosed_;                  ///< last publication of diagnostics
  ros::SteadyTime reported_;                   ///< last time at which the progress was examined
  bool is_linked_ = false;                     ///< true since the states for display have a publisher
  SessionProgress progress_;                   ///< as published, and the newest error
  std::vector<results::SessionError> errors_;  ///< of the recording, as far as they are found
  ros::Publisher progress_publisher_, verdict_publisher_, mark_publisher_;
  diagnostic_updater::Updater diagnostics_;
  // Last, so that they end before the members that their callbacks use.
  std::optional<RecordedTopics> topics_;
  ros::Subscriber runs_;
  ros::ServiceServer start_, stop_, mark_, subject_;
  ros::SteadyTimer timer_;
};

}  // namespace endovascular_sim::nodes
