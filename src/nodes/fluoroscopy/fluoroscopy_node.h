#pragma once

#include <cstdint>
#include <deque>
#include <optional>
#include <string>
#include <vector>

#include <diagnostic_updater/diagnostic_updater.h>
#include <ros/ros.h>
#include <tf2_msgs/TFMessage.h>
#include <tf2_ros/static_transform_broadcaster.h>

#include "endovascular_sim/CArm.h"
#include "endovascular_sim/ContrastState.h"
#include "endovascular_sim/MotionState.h"
#include "endovascular_sim/RodStateVisual.h"
#include "endovascular_sim/SetXRayMode.h"
#include "endovascular_sim/TreatmentVisual.h"
#include "endovascular_sim/VesselCentreline.h"
#include "endovascular_sim/VesselMesh.h"
#include "endovascular_sim/XRayFrame.h"
#include "nodes/fluoroscopy/frame_counter.h"
#include "nodes/fluoroscopy/pulse_states.h"
#include "nodes/fluoroscopy/x_ray_room.h"
#include "nodes/runtime/node_program.h"
#include "nodes/runtime/real_time.h"

namespace endovascular_sim::nodes
{

/** ROS node of fluoroscopy, an XRayRoom with topics: moves the C-arm and its table at frame rate, and renders the
 * images while one of their topics has a subscriber: the newest pulse that it has, or every pulse while a mask is
 * taken. While no pulse follows, as in a pause, the last one is drawn again. With `~follows_recording` it takes the
 * poses of the C-arm from /tf. */
class FluoroscopyNode
{
public:
  /** @param parameters handle of the private parameters
   *  @param scene scene with fluoroscopy
   *  @param request called when the patient is loaded and the lumen divided: before, the node has ordinary scheduling,
   *         because a busy machine leaves an idle one no time for them
   *  @throws InputError when the material library is invalid */
  FluoroscopyNode(ros::NodeHandle node, const ros::NodeHandle& parameters, const scene::Scene& scene,
                  SchedulingRequest request);

private:
  void receiveMesh(const VesselMesh& message);
  void receiveCentreline(const VesselCentreline& message);
  void loadPatient();
  void requestScheduling(bool is_prepared);
  void receiveRod(const RodStateVisual& message);
  void receiveTreatment(const TreatmentVisual& message);
  void receiveMotion(const MotionState& message);
  void receiveContrast(const ContrastState& message);
  void receiveCommand(const CArm& message);
  /** Takes over the pose of the C-arm from a recording. */
  void receivePoses(const tf2_msgs::TFMessage& message);
  void advanceGantry();
  void broadcastPose(const ros::Time& stamp);
  bool hasSubscribers() const;
  std::string summary() const;
  void onGantry(const ros::SteadyTimerEvent& event);
  void onPulse(const ros::SteadyTimerEvent& event);
  std::optional<ros::Time> takePulse();
  bool isDueAgain() const;
  void drawFrame();
  void publishFrame(const fluoroscopy::AngiographyFrame& frame, const ros::Time& stamp);
  bool answer(const SetXRayMode::Request& request, SetXRayMode::Response& response);
  void setMode(const SetXRayMode::Request& request);
  void onDiagnostics(const ros::SteadyTimerEvent& event);
  void diagnose(diagnostic_updater::DiagnosticStatusWrapper& status);

  /** Processes input from other nodes; reports invalid input, which changes nothing. */
  template <typename Work>
  void processInput(const Work& work);

  double rate_;                     ///< of the frames [Hz]
  double time_step_;                ///< of the simulation [s]
  bool has_recorded_pose_ = false;  ///< true: a recording gives the pose of the C-arm
  XRayRoom room_;
  PulseStates states_;
  std::uint64_t pulse_ = 0, steps_ = 0;             ///< of the present state
  ros::Time image_stamp_;                           ///< of the last image
  ros::SteadyTime draw_time_;                       ///< of the last frame
  std::optional<fluoroscopy::CArmPose> draw_pose_;  ///< of the last frame
  std::string patient_error_;                       ///< reason why the patient cannot be loaded
  ros::SteadyTime gantry_time_;                     ///< time up to which the gantry has moved
  ros::Time gantry_ros_time_;                       ///< the same
  ros::SteadyTime broadcast_time_;                  ///< of the last pose on /tf
  std::deque<ros::Time> broadcast_stamps_;          ///< stamps of the last ones

  SchedulingRequest request_;
  SchedulingGrant grant_;
  FrameCounter frames_;
  double air_kerma_rate_ = 0.0;  ///< of the last frame at the reference point [Gy/s]
  bool dose_limited_ = false;
  std::vector<double> render_times_;    ///< render times since the last diagnostics [s]
  std::string new_error_, last_error_;  ///< error since the last diagnostics, last error of all

  /** Topics of one view. */
  struct View
  {
    ros::Publisher raw, image, camera_info;
    bool hasSubscribers() const
    {
      return raw.getNumSubscribers() + image.getNumSubscribers() + camera_info.getNumSubscribers() > 0;
    }
  };
  View radiograph_, source_view_;
  ros::Publisher dsa_, frame_;
  tf2_msgs::TFMessage pose_;  ///< newest pose on /tf
  ros::Publisher pose_publisher_;
  tf2_ros::StaticTransformBroadcaster static_broadcaster_;
  diagnostic_updater::Updater updater_;
  // Last, so that they end before the members that their callbacks use.
  ros::Subscriber mesh_subscriber_, centreline_subscriber_, motion_subscriber_, contrast_subscriber_, rod_subscriber_,
      treatment_subscriber_, c_arm_subscriber_, pose_subscriber_;
  ros::ServiceServer mode_service_;
  ros::SteadyTimer gantry_timer_, pulse_timer_, diagnostics_timer_;
};

}  // namespace endovascular_sim::nodes
