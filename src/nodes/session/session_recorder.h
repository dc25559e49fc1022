#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include <diagnostic_msgs/DiagnosticArray.h>
#include <diagnostic_updater/diagnostic_updater.h>
#include <ros/ros.h>
#include <sensor_msgs/CameraInfo.h>
#include <sensor_msgs/Image.h>
#include <std_srvs/Trigger.h>

#include "endovascular_sim/ContactForceMap.h"
#include "endovascular_sim/ContactForces.h"
#include "endovascular_sim/DriveApplied.h"
#include "endovascular_sim/RodStateVisual.h"
#include "endovascular_sim/SessionInfo.h"
#include "endovascular_sim/SessionProgress.h"
#include "endovascular_sim/SessionSteps.h"
#include "endovascular_sim/SimulationRun.h"
#include "endovascular_sim/VesselCentreline.h"
#include "endovascular_sim/VesselMesh.h"
#include "nodes/conversions/joint_state_conversions.h"
#include "nodes/runtime/one_source.h"
#include "nodes/session/recording.h"
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

/** Recorder of a session: subscribes to the topics of a scene, records them, and writes the report at the end. A reset
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
  void subscribeToWire();
  void subscribeToVessel();
  void subscribeToFluoroscopy();
  void subscribeToGraph();
  void publishInfo();

  template <typename Message>
  void listen(const std::string& topic, std::uint32_t queue,
              std::function<void(const ros::MessageEvent<Message const>&)> callback);
  /** Subscribes to a topic and records all of its messages. */
  template <typename Message>
  void record(const std::string& topic, std::uint32_t queue);
  /** As record(); the newest message of each publisher also begins every further recording. */
  template <typename Message>
  void recordLatched(const std::string& topic, std::uint32_t queue);
  /** As record(); also adds the messages to the metrics, which may refuse them. */
  template <typename Message>
  void measure(const std::string& topic, std::uint32_t queue);

  bool isNext(const SessionSteps& group);
  template <typename Message>
  void requireKnown(const Message& message, const std::string& topic) const;
  void onSteps(const ros::MessageEvent<SessionSteps const>& event);
  void recordStep(const DriveAppliedConstPtr& step, ros::Time time);
  void onRod(const ros::MessageEvent<RodStateVisual const>& event);
  void recordSetpoints(const DriveApplied& drive, ros::Time time);
  void recordMeasurements(const RodStateVisual& rod, ros::Time time);
  void recordJoints(std::size_t k, const char* topic, const JointValues& values, double force, double torque,
                    ros::Time stamp, ros::Time time);
  void onContacts(const ros::MessageEvent<ContactForces const>& event);
  void onForceMap(const ros::MessageEvent<ContactForceMap const>& event);
  void onVessel(const ros::MessageEvent<VesselMesh const>& event);
  void onCentreline(const ros::MessageEvent<VesselCentreline const>& event);
  void onImage(const ros::MessageEvent<sensor_msgs::Image const>& event);
  void onDiagnostics(const ros::MessageEvent<diagnostic_msgs::DiagnosticArray const>& event);
  void onRun(const ros::MessageEvent<SimulationRun const>& event);
  void onTimer(const ros::SteadyTimerEvent&);
  bool onStop(std_srvs::Trigger::Request& request, std_srvs::Trigger::Response& response);

  void savePicture(const sensor_msgs::ImageConstPtr& image);
  /** Reports whether the last step of the scene is recorded and the session ends with it. */
  bool durationIsOver() const;
  void logProgress();
  void fillDiagnostics(diagnostic_updater::DiagnosticStatusWrapper& status) const;
  void endWith(const std::string& error);
  bool isRecording() const { return !finished_ && !stopped_; }
  void beginRun();
  /** Closes the bag and writes the report; the next run begins a further recording. */
  void stop();
  bool closeRecording();
  void publishProgress();

  ros::NodeHandle node_;
  scene::Scene scene_;
  RecorderSettings settings_;
  SessionInfo info_;
  std::unique_ptr<Recording> recording_;
  std::uint32_t run_ = 0;      ///< run of the recording; 0 before the first message about it
  std::uint64_t handled_ = 0;  ///< number of steps, up to the last one that has arrived
  OneSource steps_source_;
  std::uint64_t after_gap_ = 0;  ///< step after the last one that has arrived, whether or not it followed
  SimulationRunConstPtr next_;   ///< run that is to be recorded; null without one
  ros::SteadyTime next_since_;   ///< arrival of next_
  /** Messages that begin every recording, by their topic and publisher. */
  std::map<std::string, std::function<void(Recording&)>> latched_;
  bool info_published_ = false;
  bool finished_ = false;  ///< the session has ended
  bool stopped_ = false;   ///< the recording is closed, and no further one has begun
  bool complete_ = true;
  ros::SteadyTime last_step_;  ///< arrival of the last step
  double logged_time_ = 0.0;   ///< simulated time of the last progress message [s]
  ros::SteadyTime diagnosed_;  ///< last publication of diagnostics
  ros::SteadyTime reported_;   ///< last publication of the progress
  SessionProgress progress_;   ///< as published
  ros::Publisher info_publisher_, progress_publisher_;
  diagnostic_updater::Updater diagnostics_;
  // Last, so that they end before the members that their callbacks use.
  std::vector<ros::Subscriber> subscribers_;
  ros::ServiceServer stop_;
  ros::SteadyTimer timer_;
};

}  // namespace endovascular_sim::nodes
