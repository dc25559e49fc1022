#include <sched.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <cstring>
#include <optional>
#include <string>
#include <vector>

#include <diagnostic_updater/diagnostic_updater.h>
#include <ros/package.h>
#include <ros/ros.h>
#include <tf2_ros/static_transform_broadcaster.h>

#include "common/error.h"
#include "nodes/conversions/image_conversions.h"
#include "nodes/conversions/treatment_conversions.h"
#include "nodes/runtime/real_time.h"
#include "nodes/runtime/ros_names.h"
#include "nodes/runtime/scene_parameters.h"
#include "simulation/fluoroscopy_system.h"

namespace endovascular_sim::nodes
{
namespace
{

constexpr double kDiagnosticsPeriod = 1.0;  ///< [s]

/** Draws what the C-arm sees, as long as somebody looks. */
class Fluoroscopy
{
public:
  Fluoroscopy(ros::NodeHandle& node, const scene::Scene& scene, const fluoroscopy::AttenuationTable& table,
              std::string scheduling)
    : scene_(scene),
      room_(scene_, table),
      xray_(*scene_.fluoroscopy),
      fluoroscope_(room_.fluoroscope()),
      isocentre_known_(xray_.isocentre.has_value()),
      scheduling_(std::move(scheduling)),
      raw_(node.advertise<sensor_msgs::Image>(names::kFluoroscopyRaw, 2)),
      image_(node.advertise<sensor_msgs::Image>(names::kFluoroscopyImage, 2)),
      camera_info_(node.advertise<sensor_msgs::CameraInfo>(names::kFluoroscopyCameraInfo, 2))
  {
    const ros::TransportHints no_delay = ros::TransportHints().tcpNoDelay();
    mesh_subscriber_ = node.subscribe(names::kVesselMesh, 1, &Fluoroscopy::takeMesh, this, no_delay);
    rod_subscriber_ = node.subscribe(names::kRodStateVisual, 1, &Fluoroscopy::takeRod, this, no_delay);
    treatment_subscriber_ = node.subscribe(names::kTreatmentVisual, 1, &Fluoroscopy::takeTreatment, this, no_delay);
    c_arm_subscriber_ = node.subscribe(names::kCArmCommand, 1, &Fluoroscopy::takeCommand, this, no_delay);
    updater_.setHardwareID("simulated C-arm");
    updater_.add("Fluoroscopy", this, &Fluoroscopy::diagnose);
    broadcastPose();
    frame_timer_ = node.createSteadyTimer(ros::WallDuration(1.0 / xray_.rate), &Fluoroscopy::onFrame, this);
    diagnostics_timer_ =
        node.createSteadyTimer(ros::WallDuration(kDiagnosticsPeriod), &Fluoroscopy::onDiagnostics, this);
  }

private:
  void takeMesh(const VesselMesh& message)
  {
    guarded(
        [&]
        {
          geometry::TriangleMesh mesh = toMesh(message);
          if (!isocentre_known_ && !mesh.vertices.empty())
          {
            Eigen::AlignedBox3d box;
            for (const Eigen::Vector3d& vertex : mesh.vertices)
              box.extend(vertex);
            moveIsocentre(box.center());
          }
          fluoroscope_.setVessel(std::move(mesh));
          has_mesh_ = true;
        });
  }

  void takeRod(const RodStateVisual& message)
  {
    guarded([&] { wires_ = toXRayWires(message, room_.instruments()); });
    if (!message.nodes.empty())
      tip_ = toEigen(message.nodes.back());
    if (!scene_.vessel && !isocentre_known_ && !message.nodes.empty())
      guarded([&] { moveIsocentre(toEigen(message.nodes[message.nodes.size() / 2])); });
  }

  void takeTreatment(const TreatmentVisual& message)
  {
    guarded([&] { treatment_ = toXRayWires(message, room_.filling(), room_.metal()); });
  }

  void takeCommand(const CArm& message)
  {
    guarded(
        [&]
        {
          move(toPose(message, xray_.pixels));
          isocentre_known_ = true;
        });
  }

  void moveIsocentre(const Eigen::Vector3d& isocentre)
  {
    fluoroscopy::CArmPose pose = fluoroscope_.geometry().pose();
    pose.isocentre = isocentre;
    move(pose);
    isocentre_known_ = true;
  }

  void move(const fluoroscopy::CArmPose& pose)
  {
    if (pose == fluoroscope_.geometry().pose())
      return;
    fluoroscope_.setPose(pose);
    broadcastPose();
  }

  void broadcastPose() { broadcaster_.sendTransform(toTransform(ros::Time::now(), fluoroscope_.geometry())); }

  bool watched() const
  {
    return raw_.getNumSubscribers() + image_.getNumSubscribers() + camera_info_.getNumSubscribers() > 0;
  }

  void onFrame(const ros::SteadyTimerEvent& /*event*/)
  {
    if (!watched() || (scene_.vessel && !has_mesh_))
      return;
    guarded(
        [&]
        {
          if (xray_.follow_tip && tip_)
            move(fluoroscopy::panToTip(fluoroscope_.geometry().pose(), *tip_));
          publishFrame();
        });
  }

  void publishFrame()
  {
    const auto begin = std::chrono::steady_clock::now();
    std_msgs::Header header;
    header.stamp = ros::Time::now();
    header.frame_id = names::kXRaySourceFrame;
    std::vector<fluoroscopy::XRayWire> wires = wires_;
    wires.insert(wires.end(), treatment_.begin(), treatment_.end());
    const fluoroscopy::Frame& frame = fluoroscope_.render(wires);
    render_times_.push_back(std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count());
    ++frames_;
    camera_info_.publish(toCameraInfo(header, fluoroscope_.geometry()));
    if (raw_.getNumSubscribers() > 0)
      raw_.publish(toImage(header, frame.pixels, frame.raw));
    if (image_.getNumSubscribers() > 0)
      image_.publish(toImage(header, frame.pixels, frame.image));
  }

  void onDiagnostics(const ros::SteadyTimerEvent& /*event*/) { updater_.force_update(); }

  void diagnose(diagnostic_updater::DiagnosticStatusWrapper& status)
  {
    using diagnostic_msgs::DiagnosticStatus;
    double median = 0.0;
    if (!render_times_.empty())
    {
      const auto middle = render_times_.begin() + static_cast<std::ptrdiff_t>(render_times_.size() / 2);
      std::nth_element(render_times_.begin(), middle, render_times_.end());
      median = *middle;
    }
    if (scene_.vessel && !has_mesh_)
      status.summary(DiagnosticStatus::WARN, "waiting for the vessel");
    else if (!new_error_.empty())
      status.summary(DiagnosticStatus::WARN, new_error_);
    else
      status.summary(DiagnosticStatus::OK, watched() ? "rendering" : "idle: nobody listens");
    status.add("frames rendered", frames_);
    status.add("frames per second", static_cast<double>(render_times_.size()) / kDiagnosticsPeriod);
    status.add("median render time [ms]", 1e3 * median);
    status.add("scheduling", scheduling_);
    status.add("last error", last_error_);
    render_times_.clear();
    new_error_.clear();
  }

  /** Runs a piece of work on input from outside; input that cannot be used is told and changes nothing. */
  template <typename Work>
  void guarded(const Work& work)
  {
    try
    {
      work();
    }
    catch (const InputError& error)
    {
      ROS_WARN_THROTTLE(1.0, "%s", error.what());
      new_error_ = last_error_ = error.what();
    }
  }

  scene::Scene scene_;
  simulation::FluoroscopySystem room_;
  scene::FluoroscopyScene xray_;
  fluoroscopy::Fluoroscope& fluoroscope_;
  std::vector<fluoroscopy::XRayWire> wires_;
  std::vector<fluoroscopy::XRayWire> treatment_;  ///< balloons and stents
  std::optional<Eigen::Vector3d> tip_;            ///< of the instrument that reaches furthest [m]
  bool has_mesh_ = false;
  bool isocentre_known_;

  std::string scheduling_;
  std::size_t frames_ = 0;
  std::vector<double> render_times_;  // since the last diagnostics [s]
  std::string new_error_, last_error_;

  ros::Publisher raw_, image_, camera_info_;
  ros::Subscriber mesh_subscriber_, rod_subscriber_, treatment_subscriber_, c_arm_subscriber_;
  tf2_ros::StaticTransformBroadcaster broadcaster_;
  diagnostic_updater::Updater updater_;
  ros::SteadyTimer frame_timer_, diagnostics_timer_;
};

/** Gives way to the nodes that must be in time. Threads made later inherit it.
 *  @return what was reached, for people */
std::string askForIdleScheduling()
{
  const sched_param parameter{};
  if (sched_setscheduler(0, SCHED_IDLE, &parameter) == 0)
    return "SCHED_IDLE";
  const std::string reason = std::strerror(errno);
  ROS_WARN(
      "SCHED_IDLE was refused (%s): rendering may delay the simulation's steps; start this node with "
      "`chrt --idle 0` or `nice -n 19`",
      reason.c_str());
  return "default (SCHED_IDLE was refused: " + reason + ")";
}

/** The table named by the private parameter `attenuation_table`, or the package's own. */
fluoroscopy::AttenuationTable attenuationTable()
{
  const std::string own = ros::package::getPath("endovascular_sim") + "/config/xray/attenuation.yaml";
  return fluoroscopy::AttenuationTable::load(ros::NodeHandle("~").param<std::string>("attenuation_table", own));
}

}  // namespace
}  // namespace endovascular_sim::nodes

int main(int argc, char** argv)
{
  endovascular_sim::nodes::keepOffLockStepCpu();
  ros::init(argc, argv, "fluoroscopy");
  const std::string scheduling = endovascular_sim::nodes::askForIdleScheduling();
  ros::NodeHandle node;
  try
  {
    endovascular_sim::nodes::Fluoroscopy fluoroscopy(node, endovascular_sim::nodes::sceneFromParameters(node),
                                                     endovascular_sim::nodes::attenuationTable(), scheduling);
    ros::spin();
    return 0;
  }
  catch (const std::exception& error)
  {
    ROS_FATAL("%s", error.what());
    return 1;
  }
}
