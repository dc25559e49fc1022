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
#include "nodes/session/bag_writer.h"
#include "nodes/session/metrics_recorder.h"
#include "results/report.h"
#include "results/trajectory_csv.h"
#include "scene/model/scene.h"

namespace endovascular_sim::nodes
{

/** Lets one message through per slot of time. */
class Throttle
{
public:
  explicit Throttle(double rate) : rate_(rate) {}
  /** @param time [s]; going back in time begins anew */
  bool passes(double time);

private:
  double rate_;
  double last_slot_ = -1.0;
};

/** How a session is recorded; read from the session node's private parameters. */
struct RecorderSettings
{
  std::string folder;             ///< where everything is written
  bool stop_at_duration = false;  ///< end the node when the scene's duration is over
  double patience = 60.0;         ///< with stop_at_duration: give up after this time without a step [s]
  double start_patience = 600.0;  ///< the same before the first step, while vessels are generated [s]
  int picture_interval = 15;      ///< every n-th fluoroscopy frame is kept as PNG; 0: none
};

/** Subscribes to everything that a scene produces, records it, and writes the report at the end. */
class SessionRecorder
{
public:
  /** @throws InputError when the folder or a file in it cannot be made */
  SessionRecorder(ros::NodeHandle node, scene::Scene scene, RecorderSettings settings);
  ~SessionRecorder();

  /** Closes the bag and writes report.json; nothing when that has been done. @return true when all is complete */
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
  /** Records a topic as it comes. */
  template <typename Message>
  void record(const std::string& topic, std::uint32_t queue);
  /** The same, and shows it to the metrics. */
  template <typename Message>
  void measure(const std::string& topic, std::uint32_t queue);

  void onDrive(const ros::MessageEvent<DriveApplied const>& event);
  void onRod(const ros::MessageEvent<RodStateVisual const>& event);
  void recordHands(const DriveApplied& drive, ros::Time time);
  void onContacts(const ros::MessageEvent<ContactForces const>& event);
  void onForceMap(const ros::MessageEvent<ContactForceMap const>& event);
  void onVessel(const ros::MessageEvent<VesselMesh const>& event);
  void onImage(const ros::MessageEvent<sensor_msgs::Image const>& event);
  void onDiagnostics(const ros::MessageEvent<diagnostic_msgs::DiagnosticArray const>& event);
  void onTimer(const ros::SteadyTimerEvent&);
  bool onStop(std_srvs::Trigger::Request& request, std_srvs::Trigger::Response& response);

  /** metrics.json, metrics.html and instruments.csv. @return false when the disk refused them */
  bool writeMetrics();
  /** wall_forces.csv and vessel_points.csv. @return false when the disk refused them */
  bool writeWallForces() const;
  void savePicture(const sensor_msgs::ImageConstPtr& image);
  /** True when the scene's last step is in, and the session is to end with it. */
  bool durationIsOver() const;
  void tellProgress();
  void fillDiagnostics(diagnostic_updater::DiagnosticStatusWrapper& status) const;
  void endWith(const std::string& error);
  std::string path(const std::string& name) const { return settings_.folder + "/" + name; }

  ros::NodeHandle node_;
  scene::Scene scene_;
  RecorderSettings settings_;
  SessionInfo info_;
  results::SessionReport report_;
  results::TrajectoryFile trajectory_;
  MetricsRecorder metrics_;
  BagWriter bag_;
  Throttle pose_;
  Throttle joints_;
  Throttle contacts_;
  ContactForceMapConstPtr force_map_;  ///< the newest
  VesselMeshConstPtr vessel_;
  std::uint64_t frames_ = 0;
  bool info_published_ = false;
  bool finished_ = false;
  bool complete_ = false;
  std::string error_;
  ros::SteadyTime last_step_;
  double told_ = 0.0;
  std::vector<ros::Subscriber> subscribers_;
  ros::Publisher info_publisher_;
  ros::ServiceServer stop_;
  ros::SteadyTimer timer_;
  diagnostic_updater::Updater diagnostics_;
};

}  // namespace endovascular_sim::nodes
