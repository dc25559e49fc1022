#pragma once

#include <cstdint>
#include <functional>
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
#include "endovascular_sim/VesselMesh.h"
#include "nodes/conversions/joint_state_conversions.h"
#include "nodes/session/bag_writer.h"
#include "nodes/session/session_results.h"
#include "nodes/session/throttle.h"
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

/** Recorder of a session: subscribes to the topics of a scene, records them, and writes the report at the end. */
class SessionRecorder
{
public:
  /** @throws InputError when the folder or a file in it cannot be created */
  SessionRecorder(const ros::NodeHandle& node, scene::Scene scene, RecorderSettings settings);
  ~SessionRecorder();

  /** Closes the bag and writes the report; further calls have no effect. @return true when everything was written */
  bool finish();

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
  /** As record(); also adds the messages to the metrics. */
  template <typename Message>
  void measure(const std::string& topic, std::uint32_t queue);

  void onDrive(const ros::MessageEvent<DriveApplied const>& event);
  void onRod(const ros::MessageEvent<RodStateVisual const>& event);
  void recordSetpoints(const DriveApplied& drive, ros::Time time);
  void recordMeasurements(const RodStateVisual& rod, ros::Time time);
  void recordJoints(std::size_t k, const char* topic, const JointValues& values, double force, double torque,
                    ros::Time stamp, ros::Time time);
  void onContacts(const ros::MessageEvent<ContactForces const>& event);
  void onForceMap(const ros::MessageEvent<ContactForceMap const>& event);
  void onVessel(const ros::MessageEvent<VesselMesh const>& event);
  void onImage(const ros::MessageEvent<sensor_msgs::Image const>& event);
  void onDiagnostics(const ros::MessageEvent<diagnostic_msgs::DiagnosticArray const>& event);
  void onTimer(const ros::SteadyTimerEvent&);
  bool onStop(std_srvs::Trigger::Request& request, std_srvs::Trigger::Response& response);

  void savePicture(const sensor_msgs::ImageConstPtr& image);
  /** Reports whether the last step of the scene is recorded and the session ends with it. */
  bool durationIsOver() const;
  void logProgress();
  void fillDiagnostics(diagnostic_updater::DiagnosticStatusWrapper& status) const;
  void endWith(const std::string& error);
  std::string path(const std::string& name) const { return settings_.folder + "/" + name; }

  ros::NodeHandle node_;
  scene::Scene scene_;
  RecorderSettings settings_;
  SessionInfo info_;
  SessionResults results_;
  BagWriter bag_;
  Throttle pose_;
  Throttle joints_;
  Throttle contacts_;
  std::uint64_t frames_ = 0;
  bool info_published_ = false;
  bool finished_ = false;
  bool complete_ = false;
  std::string error_;          ///< reason of an early end; empty without one
  ros::SteadyTime last_step_;  ///< arrival of the last step
  double logged_time_ = 0.0;   ///< simulated time of the last progress message [s]
  ros::Publisher info_publisher_;
  diagnostic_updater::Updater diagnostics_;
  // Last, so that they end before the members that their callbacks use.
  std::vector<ros::Subscriber> subscribers_;
  ros::ServiceServer stop_;
  ros::SteadyTimer timer_;
};

}  // namespace endovascular_sim::nodes
