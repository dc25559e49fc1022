#include "nodes/fluoroscopy/fluoroscopy_node.h"

#include <algorithm>
#include <chrono>
#include <utility>

#include <ros/package.h>

#include "common/error.h"
#include "nodes/conversions/image_conversions.h"
#include "nodes/conversions/treatment_conversions.h"
#include "nodes/conversions/vessel_conversions.h"
#include "nodes/runtime/ros_names.h"
#include "simulation/x_ray_patient.h"

namespace endovascular_sim::nodes
{
namespace
{

constexpr double kDiagnosticsPeriod = 1.0;  ///< [s]

/** Material library of the private parameter `materials`; by default that of the package. */
fluoroscopy::MaterialLibrary materialLibrary(const ros::NodeHandle& parameters)
{
  const std::string own = ros::package::getPath("endovascular_sim") + "/config/xray/materials.yaml";
  auto library = fluoroscopy::MaterialLibrary::load(parameters.param<std::string>("materials", own));
  for (const std::string& warning : library.warnings())
    ROS_WARN("%s", warning.c_str());
  return library;
}

}  // namespace

template <typename Work>
void FluoroscopyNode::processInput(const Work& work)
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

FluoroscopyNode::FluoroscopyNode(ros::NodeHandle node, const ros::NodeHandle& parameters, const scene::Scene& scene,
                                 SchedulingGrant grant)
  : scene_(scene),
    system_(scene_, materialLibrary(parameters)),
    settings_(*scene_.fluoroscopy),
    fluoroscope_(system_.fluoroscope()),
    needs_patient_(settings_.patient.has_value()),
    isocentre_known_(settings_.isocentre.has_value()),
    grant_(std::move(grant)),
    raw_(node.advertise<sensor_msgs::Image>(names::kFluoroscopyRaw, 2)),
    image_(node.advertise<sensor_msgs::Image>(names::kFluoroscopyImage, 2)),
    camera_info_(node.advertise<sensor_msgs::CameraInfo>(names::kFluoroscopyCameraInfo, 2))
{
  const ros::TransportHints no_delay = ros::TransportHints().tcpNoDelay();
  mesh_subscriber_ = node.subscribe(names::kVesselMesh, 1, &FluoroscopyNode::receiveMesh, this, no_delay);
  if (needs_patient_)
    centreline_subscriber_ =
        node.subscribe(names::kVesselCentreline, 1, &FluoroscopyNode::receiveCentreline, this, no_delay);
  rod_subscriber_ = node.subscribe(names::kRodStateVisual, 1, &FluoroscopyNode::receiveRod, this, no_delay);
  treatment_subscriber_ =
      node.subscribe(names::kTreatmentVisual, 1, &FluoroscopyNode::receiveTreatment, this, no_delay);
  c_arm_subscriber_ = node.subscribe(names::kCArmCommand, 1, &FluoroscopyNode::receiveCommand, this, no_delay);
  updater_.setHardwareID("simulated C-arm");
  updater_.add("Fluoroscopy", this, &FluoroscopyNode::diagnose);
  broadcastPose();
  if (!scene_.vessel)
    loadPatient();
  frame_timer_ = node.createSteadyTimer(ros::WallDuration(1.0 / settings_.rate), &FluoroscopyNode::onFrame, this);
  diagnostics_timer_ =
      node.createSteadyTimer(ros::WallDuration(kDiagnosticsPeriod), &FluoroscopyNode::onDiagnostics, this);
}

void FluoroscopyNode::receiveMesh(const VesselMesh& message)
{
  processInput(
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
        if (needs_patient_)
          vessel_.mesh = mesh;
        fluoroscope_.setVessel(std::move(mesh));
        has_mesh_ = true;
        loadPatient();
      });
}

void FluoroscopyNode::receiveCentreline(const VesselCentreline& message)
{
  processInput(
      [&]
      {
        vessel_.centreline = fromMessage(message);
        loadPatient();
      });
}

/** Loads the patient of the scene when mesh and centreline of its vessel are known. No frame is drawn before. */
void FluoroscopyNode::loadPatient()
{
  const bool has_vessel = !vessel_.mesh.triangles.empty() && !vessel_.centreline.branches.empty();
  if (!needs_patient_ || (scene_.vessel && !has_vessel))
    return;
  const vessel::Vessel vessel = std::exchange(vessel_, {});
  try
  {
    ROS_INFO("loading the patient; the first run with this vessel makes its body, which takes some seconds");
    simulation::XRayPatient loaded =
        simulation::loadPatient(scene_, vessel, simulation::sequenceResolution(settings_.rate));
    for (const std::string& note : loaded.notes)
      ROS_INFO("patient: %s", note.c_str());
    fluoroscope_.setPatient(std::move(loaded.patient));
    needs_patient_ = false;
  }
  catch (const InputError& error)
  {
    patient_error_ = error.what();
    ROS_ERROR("no X-ray image without the patient: %s", error.what());
  }
}

void FluoroscopyNode::receiveRod(const RodStateVisual& message)
{
  processInput([&] { wires_ = toXRayWires(message, system_.instruments(), system_.fluids()); });
  if (!message.nodes.empty())
    tip_ = toEigen(message.nodes.back());
  if (!scene_.vessel && !isocentre_known_ && !message.nodes.empty())
    processInput([&] { moveIsocentre(toEigen(message.nodes[message.nodes.size() / 2])); });
}

void FluoroscopyNode::receiveTreatment(const TreatmentVisual& message)
{
  processInput([&] { treatment_ = toXRayWires(message, system_.filling(), system_.metal()); });
}

void FluoroscopyNode::receiveCommand(const CArm& message)
{
  processInput(
      [&]
      {
        move(toPose(message, settings_.pixels));
        isocentre_known_ = true;
      });
}

void FluoroscopyNode::moveIsocentre(const Eigen::Vector3d& isocentre)
{
  fluoroscopy::CArmPose pose = fluoroscope_.geometry().pose();
  pose.isocentre = isocentre;
  move(pose);
  isocentre_known_ = true;
}

void FluoroscopyNode::move(const fluoroscopy::CArmPose& pose)
{
  if (pose == fluoroscope_.geometry().pose())
    return;
  fluoroscope_.setPose(pose);
  broadcastPose();
}

void FluoroscopyNode::broadcastPose()
{
  broadcaster_.sendTransform(toTransform(ros::Time::now(), fluoroscope_.geometry()));
}

bool FluoroscopyNode::hasSubscribers() const
{
  return raw_.getNumSubscribers() + image_.getNumSubscribers() + camera_info_.getNumSubscribers() > 0;
}

void FluoroscopyNode::onFrame(const ros::SteadyTimerEvent& /*event*/)
{
  if (!hasSubscribers() || needs_patient_ || (scene_.vessel && !has_mesh_))
    return;
  processInput(
      [&]
      {
        if (settings_.follow_tip && tip_)
          move(fluoroscopy::panToTip(fluoroscope_.geometry().pose(), *tip_));
        publishFrame();
      });
}

void FluoroscopyNode::publishFrame()
{
  const auto begin = std::chrono::steady_clock::now();
  std_msgs::Header header;
  header.stamp = ros::Time::now();
  header.frame_id = names::kXRaySourceFrame;
  std::vector<fluoroscopy::XRayWire> wires = wires_;
  wires.insert(wires.end(), treatment_.begin(), treatment_.end());
  const fluoroscopy::Frame& frame = fluoroscope_.render(wires, image_.getNumSubscribers() > 0);
  render_times_.push_back(std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count());
  ++frames_;
  air_kerma_rate_ = frame.reference_kerma * settings_.rate;
  dose_limited_ = frame.dose_limited;
  camera_info_.publish(toCameraInfo(header, fluoroscope_.geometry()));
  if (raw_.getNumSubscribers() > 0)
    raw_.publish(toImage(header, frame.pixels, frame.raw));
  if (image_.getNumSubscribers() > 0)
    image_.publish(toImage(header, frame.pixels, frame.image));
}

void FluoroscopyNode::onDiagnostics(const ros::SteadyTimerEvent& /*event*/)
{
  updater_.force_update();
}

void FluoroscopyNode::diagnose(diagnostic_updater::DiagnosticStatusWrapper& status)
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
  else if (!patient_error_.empty())
    status.summary(DiagnosticStatus::ERROR, patient_error_);
  else if (needs_patient_)
    status.summary(DiagnosticStatus::WARN, "waiting for the vessel's centreline, by which the patient is placed");
  else if (!new_error_.empty())
    status.summary(DiagnosticStatus::WARN, new_error_);
  else
    status.summary(DiagnosticStatus::OK, hasSubscribers() ? "rendering" : "idle: no subscriber");
  status.add("frames rendered", frames_);
  status.add("frames per second", static_cast<double>(render_times_.size()) / kDiagnosticsPeriod);
  status.add("median render time [ms]", 1e3 * median);
  status.add("air kerma rate at the reference point [mGy/min]", 60e3 * air_kerma_rate_);
  status.add("dose limited", dose_limited_);
  status.add("scheduling", grant_.describe());
  status.add("last error", last_error_);
  render_times_.clear();
  new_error_.clear();
}

}  // namespace endovascular_sim::nodes
