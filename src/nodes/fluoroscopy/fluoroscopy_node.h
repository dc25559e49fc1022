#pragma once

#include <optional>
#include <string>
#include <vector>

#include <diagnostic_updater/diagnostic_updater.h>
#include <ros/ros.h>
#include <tf2_ros/static_transform_broadcaster.h>

#include "endovascular_sim/CArm.h"
#include "endovascular_sim/RodStateVisual.h"
#include "endovascular_sim/TreatmentVisual.h"
#include "endovascular_sim/VesselCentreline.h"
#include "endovascular_sim/VesselMesh.h"
#include "nodes/runtime/real_time.h"
#include "simulation/fluoroscopy_system.h"

namespace endovascular_sim::nodes
{

/** ROS node of fluoroscopy: renders the images of the C-arm while one of its topics has a subscriber. */
class FluoroscopyNode
{
public:
  /** @param parameters handle of the private parameters
   *  @param scene scene with fluoroscopy
   *  @throws InputError when the material library is invalid */
  FluoroscopyNode(ros::NodeHandle node, const ros::NodeHandle& parameters, const scene::Scene& scene,
                  SchedulingGrant grant);

private:
  void receiveMesh(const VesselMesh& message);
  void receiveCentreline(const VesselCentreline& message);
  void loadPatient();
  void receiveRod(const RodStateVisual& message);
  void receiveTreatment(const TreatmentVisual& message);
  void receiveCommand(const CArm& message);
  void moveIsocentre(const Eigen::Vector3d& isocentre);
  void move(const fluoroscopy::CArmPose& pose);
  void broadcastPose();
  bool hasSubscribers() const;
  void onFrame(const ros::SteadyTimerEvent& event);
  void publishFrame();
  void onDiagnostics(const ros::SteadyTimerEvent& event);
  void diagnose(diagnostic_updater::DiagnosticStatusWrapper& status);

  /** Processes input from other nodes; reports invalid input, which changes nothing. */
  template <typename Work>
  void processInput(const Work& work);

  scene::Scene scene_;
  simulation::FluoroscopySystem system_;
  scene::FluoroscopyScene settings_;
  fluoroscopy::Fluoroscope& fluoroscope_;
  std::vector<fluoroscopy::XRayWire> wires_;
  std::vector<fluoroscopy::XRayWire> treatment_;  ///< balloons and stents
  std::optional<Eigen::Vector3d> tip_;            ///< tip of the instrument that reaches farthest [m]
  bool has_mesh_ = false;
  vessel::Vessel vessel_;       ///< vessel at rest, about which the patient is placed; empty afterwards
  bool needs_patient_ = false;  ///< true: the scene has a patient that is not yet loaded
  std::string patient_error_;   ///< reason why it cannot be loaded
  bool isocentre_known_;

  SchedulingGrant grant_;
  std::size_t frames_ = 0;
  double air_kerma_rate_ = 0.0;  ///< of the last frame at the reference point [Gy/s]
  bool dose_limited_ = false;
  std::vector<double> render_times_;    ///< render times since the last diagnostics [s]
  std::string new_error_, last_error_;  ///< error since the last diagnostics, last error of all

  ros::Publisher raw_, image_, camera_info_;
  tf2_ros::StaticTransformBroadcaster broadcaster_;
  diagnostic_updater::Updater updater_;
  // Last, so that they end before the members that their callbacks use.
  ros::Subscriber mesh_subscriber_, centreline_subscriber_, rod_subscriber_, treatment_subscriber_, c_arm_subscriber_;
  ros::SteadyTimer frame_timer_, diagnostics_timer_;
};

}  // namespace endovascular_sim::nodes
