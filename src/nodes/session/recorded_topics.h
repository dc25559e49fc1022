#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include <diagnostic_msgs/DiagnosticArray.h>
#include <ros/ros.h>
#include <sensor_msgs/Image.h>

#include "endovascular_sim/ContactForceMap.h"
#include "endovascular_sim/ContactForces.h"
#include "endovascular_sim/DriveApplied.h"
#include "endovascular_sim/RodStateVisual.h"
#include "endovascular_sim/SessionInfo.h"
#include "endovascular_sim/VesselCentreline.h"
#include "endovascular_sim/VesselMesh.h"
#include "nodes/conversions/joint_state_conversions.h"
#include "nodes/session/recording.h"
#include "nodes/session/step_sequence.h"
#include "scene/model/scene.h"

namespace endovascular_sim::nodes
{

/** Topics of a session: which are recorded, at which rates, and which belong to the results. */
class RecordedTopics
{
public:
  /** Subscribes to the topics of a scene.
   *  @param scene, sequence must outlive this object
   *  @param picture_interval interval of the X-ray frames that are saved as PNG [frames]; 0: none */
  RecordedTopics(const ros::NodeHandle& node, const scene::Scene& scene, int picture_interval, StepSequence& sequence);

  /** Sets the recording that receives the messages from now on; null: none. It begins with the session's identity, the
   *  vessel, and the newest messages of latched topics. */
  void recordInto(Recording* recording);

  /** Records the wall that balloons had moved before the run, as one displacement from the initial wall.
   *  @param first_step of the run */
  void recordWall(std::uint64_t first_step);

  /** Ends all subscriptions. */
  void unsubscribe() { subscribers_.clear(); }

  ros::SteadyTime lastStep() const { return last_step_; }        ///< arrival of the last recorded step
  void setLastStep(ros::SteadyTime time) { last_step_ = time; }  ///< as lastStep()

private:
  /** Place of a message at the beginning of a recording: the metrics need the mesh before the centreline. */
  enum class Rank
  {
    kMesh,
    kCentreline,
    kOther,
  };

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

  void onSteps(const ros::MessageEvent<SessionSteps const>& event);
  void recordStep(const DriveAppliedConstPtr& step, ros::Time time);
  void onRod(const ros::MessageEvent<RodStateVisual const>& event);
  /** Records joints of all instruments on a topic of theirs.
   *  @param message DriveApplied for setpoint_js, which rod_dynamics then need not publish at the step rate;
   *         RodStateVisual for measured_js */
  template <typename Message>
  void recordJoints(const char* topic, const Message& message, ros::Time time);
  void onContacts(const ros::MessageEvent<ContactForces const>& event);
  void onForceMap(const ros::MessageEvent<ContactForceMap const>& event);
  void onVessel(const ros::MessageEvent<VesselMesh const>& event);
  void onCentreline(const ros::MessageEvent<VesselCentreline const>& event);
  void onImage(const ros::MessageEvent<sensor_msgs::Image const>& event);
  void onDiagnostics(const ros::MessageEvent<diagnostic_msgs::DiagnosticArray const>& event);
  void savePicture(const sensor_msgs::ImageConstPtr& image);

  ros::NodeHandle node_;
  const scene::Scene& scene_;
  int picture_interval_;
  StepSequence& sequence_;
  Recording* recording_ = nullptr;  ///< null: none
  SessionInfo info_;
  bool info_published_ = false;
  VesselMeshConstPtr initial_wall_;  ///< null before the vessel
  /** Messages that begin every recording, by their topic and publisher. */
  std::map<std::pair<Rank, std::string>, std::function<void(Recording&)>> latched_;
  ros::SteadyTime last_step_;
  ros::Publisher info_publisher_;
  std::vector<ros::Subscriber> subscribers_;  ///< last, so that they end before the members that their callbacks use
};

}  // namespace endovascular_sim::nodes
