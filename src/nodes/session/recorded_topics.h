#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include <crtk_msgs/StringStamped.h>
#include <diagnostic_msgs/DiagnosticArray.h>
#include <ros/ros.h>
#include <sensor_msgs/CameraInfo.h>
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

/** Place of a bag in its run. */
struct BagPlace
{
  std::uint64_t first_step = 0;  ///< number of steps before the first one of the bag
  std::string continues;         ///< name of the bag before it; empty for the first one
};

/** Topics of a session: which are recorded, at which rates, and which belong to the results. */
class RecordedTopics
{
public:
  /** Subscribes to the topics of a scene.
   *  @param scene, sequence must outlive this object
   *  @param picture_interval interval of the X-ray frames that are saved as PNG [frames]; 0: none
   *  @param subject of session/info */
  RecordedTopics(const ros::NodeHandle& node, const scene::Scene& scene, int picture_interval, StepSequence& sequence,
                 const std::string& subject);

  /** Sets the recording that receives the messages from now on. It begins with the session's identity, the vessel, and
   * the newest messages of latched topics. */
  void recordInto(Recording* recording, const BagPlace& place = {});

  /** Ends the recording of messages. */
  void recordNothing() { recording_ = nullptr; }

  /** Leaves out all steps until recordInto(): those before a state from which the recording continues. */
  void waitForState() { is_waiting_ = true; }

  /** Reports whether no message of the graph can be missed any more: the vessel is there, and steps arrive or their
   * publisher has been connected for a while. */
  bool isConnected();

  /** Reports whether the states for display have a publisher: a recording that begins earlier lacks the first ones. */
  bool hasStates() const { return states_.getNumPublishers() > 0; }

  /** Records the wall that balloons had moved before the run, as one displacement from the initial wall.
   *  @param first_step of the run */
  void recordWall(std::uint64_t first_step);

  /** Records the newest state of the wires, if it is not recorded yet: the last one of a recording. */
  void recordNewestPose(Recording& recording) const;

  /** Changes the pseudonym of the trainee: session/info is published and recorded again. */
  void setSubject(const std::string& subject);

  /** Records the newest map of the wall forces, unless it is recorded already. */
  void recordNewestMap(Recording& recording) const;

  /** Ends all subscriptions. */
  void unsubscribe()
  {
    steps_.shutdown();
    subscribers_.clear();
  }

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
  void subscribeToBlood();
  void subscribeToContrast();
  void subscribeToMotion();
  void subscribeToGraph();
  void publishInfo();
  SessionInfo recordedInfo() const;

  template <typename Message>
  void listen(const std::string& topic, std::uint32_t queue,
              std::function<void(const ros::MessageEvent<Message const>&)> callback);
  /** Subscribes to a topic and records all of its messages. */
  template <typename Message>
  void record(const std::string& topic, std::uint32_t queue);
  /** As record(); the newest message of each publisher also begins every further recording. */
  template <typename Message>
  void recordLatched(const std::string& topic, std::uint32_t queue);
  /** As record(), at a lower rate of simulated time. */
  template <typename Message>
  void recordThrottled(const std::string& topic, std::uint32_t queue, Throttle Recording::*rate);
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
  /** Keeps a message that belongs to a pose until this pose is recorded. @pre recording_ is not null */
  template <typename Message>
  void onPosePart(const char* topic, const ros::MessageEvent<Message const>& event,
                  PoseParts<Message> Recording::*parts);
  template <typename Message>
  void recordPosePart(const char* topic, Recording& recording, PoseParts<Message> Recording::*parts) const;
  void onContacts(const ros::MessageEvent<ContactForces const>& event);
  void onForceMap(const ros::MessageEvent<ContactForceMap const>& event);
  void onVessel(const ros::MessageEvent<VesselMesh const>& received);
  void onCentreline(const ros::MessageEvent<VesselCentreline const>& event);
  void onCameraInfo(const ros::MessageEvent<sensor_msgs::CameraInfo const>& event);
  void onImage(const ros::MessageEvent<sensor_msgs::Image const>& event);
  void onDiagnostics(const ros::MessageEvent<diagnostic_msgs::DiagnosticArray const>& received);
  void savePicture(const sensor_msgs::ImageConstPtr& image);

  ros::NodeHandle node_;
  const scene::Scene& scene_;
  int picture_interval_;
  StepSequence& sequence_;
  Recording* recording_ = nullptr;  ///< null: none
  BagPlace place_;                  ///< of the recording
  SessionInfo info_;
  bool info_published_ = false;
  bool is_waiting_ = false;          ///< true: steps are left out until recordInto()
  bool has_steps_ = false;           ///< true when a group of steps has arrived
  ros::SteadyTime linked_;           ///< first time at which session/steps had a publisher; 0 before
  VesselMeshConstPtr initial_wall_;  ///< null before the vessel
  /** Messages that begin every recording, by their topic and publisher. */
  std::map<std::pair<Rank, std::string>, std::function<void(Recording&)>> latched_;
  ros::SteadyTime last_step_;
  ros::Publisher info_publisher_;
  ros::Subscriber steps_;                     ///< of session/steps
  ros::Subscriber states_;                    ///< of rod/state_visual
  std::vector<ros::Subscriber> subscribers_;  ///< last, so that they end before the members that their callbacks use
};

}  // namespace endovascular_sim::nodes
