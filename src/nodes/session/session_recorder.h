#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>

#include <diagnostic_updater/diagnostic_updater.h>
#include <ros/ros.h>
#include <std_srvs/Trigger.h>

#include "endovascular_sim/SessionProgress.h"
#include "endovascular_sim/SimulationRun.h"
#include "nodes/session/recorded_topics.h"
#include "nodes/session/recording.h"
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
};

/** Recorder of a session: records the topics of a scene (RecordedTopics), and writes the report at the end. A reset
 *  and a loaded state begin a further recording, in the subfolder `run_N`, also after the service session/stop. */
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

private:
  void onRun(const ros::MessageEvent<SimulationRun const>& event);
  void onTimer(const ros::SteadyTimerEvent&);
  bool onStop(std_srvs::Trigger::Request& request, std_srvs::Trigger::Response& response);
  void logProgress();
  void fillDiagnostics(diagnostic_updater::DiagnosticStatusWrapper& status) const;
  void endWith(const std::string& error);
  bool isRecording() const { return !finished_ && !stopped_; }
  void beginRun();
  /** Closes the bag and writes the report; the next run begins a further recording. */
  void stop();
  bool closeRecording();
  void updateErrors();
  void publishProgress();

  ros::NodeHandle node_;
  scene::Scene scene_;
  RecorderSettings settings_;
  std::unique_ptr<Recording> recording_;
  StepSequence sequence_;
  std::uint32_t run_ = 0;       ///< run of the recording; 0 before the first message about it
  SimulationRunConstPtr next_;  ///< run that is to be recorded; null without one
  ros::SteadyTime next_since_;  ///< arrival of next_
  bool finished_ = false;       ///< the session has ended
  bool stopped_ = false;        ///< the recording is closed, and no further one has begun
  bool complete_ = true;
  double logged_time_ = 0.0;                   ///< simulated time of the last progress message [s]
  ros::SteadyTime diagnosed_;                  ///< last publication of diagnostics
  ros::SteadyTime reported_;                   ///< last time at which the progress was examined
  SessionProgress progress_;                   ///< as published, and the newest error
  std::vector<results::SessionError> errors_;  ///< of the recording, as far as they are found
  ros::Publisher progress_publisher_;
  diagnostic_updater::Updater diagnostics_;
  // Last, so that they end before the members that their callbacks use.
  std::optional<RecordedTopics> topics_;
  ros::Subscriber runs_;
  ros::ServiceServer stop_;
  ros::SteadyTimer timer_;
};

}  // namespace endovascular_sim::nodes
