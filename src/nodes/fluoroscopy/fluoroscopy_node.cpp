#include "nodes/fluoroscopy/fluoroscopy_node.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <utility>

#include <ros/package.h>

#include "common/error.h"
#include "nodes/conversions/contact_conversions.h"
#include "nodes/conversions/image_conversions.h"
#include "nodes/conversions/motion_conversions.h"
#include "nodes/conversions/treatment_conversions.h"
#include "nodes/conversions/vessel_conversions.h"
#include "nodes/runtime/diagnostics_publication.h"
#include "nodes/runtime/guarded_subscription.h"
#include "nodes/runtime/ros_names.h"

namespace endovascular_sim::nodes
{
namespace
{

constexpr double kDiagnosticsPeriod = 1.0;  ///< [s]
constexpr int kMotionQueue = 10;            ///< of motion/state, which arrives with every state for display
constexpr int kPoseQueue = 100;             ///< of /tf, as that of tf2_ros
constexpr double kWarningPeriod = 1.0;      ///< between two warnings of the same place [s]
constexpr double kRestPeriod = 0.5;  ///< of the pose on /tf while neither the C-arm moves nor frames are drawn [s]

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
    ROS_WARN_STREAM_THROTTLE(kWarningPeriod, error.what());
    new_error_ = last_error_ = error.what();
  }
}

FluoroscopyNode::FluoroscopyNode(ros::NodeHandle node, const ros::NodeHandle& parameters, const scene::Scene& scene,
                                 SchedulingRequest request)
  : rate_(scene.fluoroscopy->rate),
    room_(scene, materialLibrary(parameters)),
    gantry_time_(ros::SteadyTime::now()),
    request_(std::move(request)),
    frames_(1.0 / scene.fluoroscopy->rate),
    radiograph_{node.advertise<sensor_msgs::Image>(names::kFluoroscopyRaw, 2),
                node.advertise<sensor_msgs::Image>(names::kFluoroscopyImage, 2),
                node.advertise<sensor_msgs::CameraInfo>(names::kFluoroscopyCameraInfo, 2)},
    source_view_{node.advertise<sensor_msgs::Image>(names::kSourceViewRaw, 2),
                 node.advertise<sensor_msgs::Image>(names::kSourceViewImage, 2),
                 node.advertise<sensor_msgs::CameraInfo>(names::kSourceViewCameraInfo, 2)}
{
  mesh_subscriber_ = subscribeGuarded<VesselMesh>(node, names::kVesselMesh, 1,
                                                  [this](const VesselMesh& message) { receiveMesh(message); });
  if (room_.awaitsPatient())
    centreline_subscriber_ = subscribeGuarded<VesselCentreline>(
        node, names::kVesselCentreline, 1, [this](const VesselCentreline& message) { receiveCentreline(message); });
  motion_subscriber_ = subscribeGuarded<MotionState>(node, names::kMotionState, kMotionQueue,
                                                     [this](const MotionState& message) { receiveMotion(message); });
  rod_subscriber_ = subscribeGuarded<RodStateVisual>(node, names::kRodStateVisual, 1,
                                                     [this](const RodStateVisual& message) { receiveRod(message); });
  treatment_subscriber_ = subscribeGuarded<TreatmentVisual>(
      node, names::kTreatmentVisual, 1, [this](const TreatmentVisual& message) { receiveTreatment(message); });
  c_arm_subscriber_ =
      subscribeGuarded<CArm>(node, names::kCArmCommand, 1, [this](const CArm& message) { receiveCommand(message); });
  if (parameters.param("follows_recording", false))
    pose_subscriber_ = subscribeGuarded<tf2_msgs::TFMessage>(
        node, "/tf", kPoseQueue,
        [this](const ros::MessageEvent<tf2_msgs::TFMessage const>& event)
        {
          if (event.getPublisherName() != ros::this_node::getName())  // its own poses are not recorded ones
            receivePoses(*event.getConstMessage());
        });
  updater_.setHardwareID("simulated C-arm");
  updater_.add("Fluoroscopy", this, &FluoroscopyNode::diagnose);
  const ros::SubscriberStatusCallback sendPose = [this](const ros::SingleSubscriberPublisher& listener)
  {
    if (!pose_.transforms.empty())
      listener.publish(pose_);
  };
  pose_publisher_ = node.advertise<tf2_msgs::TFMessage>("/tf", kPoseQueue, sendPose);
  static_broadcaster_.sendTransform(sourceViewTransform(ros::Time::now()));
  broadcastPose(ros::Time::now());
  if (!room_.awaitsPatient())
    grant_ = request_();
  loadPatient();
  frame_timer_ = node.createSteadyTimer(ros::WallDuration(1.0 / rate_), &FluoroscopyNode::onFrame, this);
  diagnostics_timer_ =
      node.createSteadyTimer(ros::WallDuration(kDiagnosticsPeriod), &FluoroscopyNode::onDiagnostics, this);
}

void FluoroscopyNode::receiveMesh(const VesselMesh& message)
{
  processInput(
      [&]
      {
        room_.setVessel(fromMessage(message));
        loadPatient();
      });
}

void FluoroscopyNode::receiveCentreline(const VesselCentreline& message)
{
  processInput(
      [&]
      {
        room_.setCentreline(fromMessage(message));
        loadPatient();
      });
}

/** Loads the patient of the scene when mesh and centreline of its vessel are known. No frame is drawn before. */
void FluoroscopyNode::loadPatient()
{
  if (!room_.canLoadPatient())
    return;
  try
  {
    ROS_INFO("loading the patient; the first run with this vessel makes its body, which takes some seconds");
    for (const std::string& note : room_.loadPatient())
      ROS_INFO("patient: %s", note.c_str());
  }
  catch (const InputError& error)
  {
    patient_error_ = error.what();
    ROS_ERROR("no X-ray image without the patient: %s", error.what());
  }
  grant_ = request_();
}

void FluoroscopyNode::receiveRod(const RodStateVisual& message)
{
  processInput(
      [&]
      {
        std::vector<Eigen::Vector3d> nodes;
        for (const geometry_msgs::Point& node : message.nodes)
          nodes.push_back(fromMessage(node));
        room_.setWires(toXRayWires(message, room_.system().instruments(), room_.system().fluids()), nodes,
                       message.step);
      });
}

void FluoroscopyNode::receiveTreatment(const TreatmentVisual& message)
{
  processInput([&] { room_.setTreatment(toXRayWires(message, room_.system().filling(), room_.system().metal())); });
}

void FluoroscopyNode::receiveMotion(const MotionState& message)
{
  processInput(
      [&]
      {
        if (!std::isfinite(message.diaphragm))
          throw InputError(names::kMotionState, "diaphragm", "must be finite");
        room_.setMotion(message.step, {fromMessage(message), message.diaphragm});
      });
}

void FluoroscopyNode::receiveCommand(const CArm& message)
{
  processInput(
      [&]
      {
        const bool names_isocentre = message.view.empty() || !fromMessage(message.isocentre).isZero(0.0);
        room_.moveTo(toPose(message, room_.gantry().target()), names_isocentre);
      });
}

void FluoroscopyNode::receivePoses(const tf2_msgs::TFMessage& message)
{
  for (const geometry_msgs::TransformStamped& pose : message.transforms)
    if (pose.header.frame_id == names::kPatientFrame && pose.child_frame_id == names::kXRaySourceFrame)
      processInput(
          [&]
          {
            room_.placeAt(poseOf(pose.transform, room_.gantry().target()));
            has_recorded_pose_ = true;
          });
}

void FluoroscopyNode::advanceGantry()
{
  if (has_recorded_pose_)
    return;
  // By the steady clock, so that the C-arm moves while the simulation is paused, or by ROS time where that is faster:
  // in a fast simulation or replay.
  const ros::SteadyTime now = ros::SteadyTime::now();
  const ros::Time ros_now = ros::Time::now();
  double duration = (now - gantry_time_).toSec();
  if (!gantry_ros_time_.isZero())
    duration = std::max(duration, ros_now.toSec() - gantry_ros_time_.toSec());  // any two times have a difference
  gantry_time_ = now;
  gantry_ros_time_ = ros_now;
  room_.advance(duration);
}

/** Publishes the pose on /tf. Simulated time may stand still, e.g. in a paused replay: a second pose of the same time
 *  would be refused by every listener. A new listener gets the newest pose. */
void FluoroscopyNode::broadcastPose(const ros::Time& stamp)
{
  if (stamp == broadcast_stamp_ || has_recorded_pose_)
    return;
  broadcast_stamp_ = stamp;
  pose_.transforms = {toTransform(stamp, room_.geometry())};
  pose_publisher_.publish(pose_);
  broadcast_time_ = ros::SteadyTime::now();
}

bool FluoroscopyNode::hasSubscribers() const
{
  return radiograph_.hasSubscribers() || source_view_.hasSubscribers();
}

void FluoroscopyNode::onFrame(const ros::SteadyTimerEvent& event)
{
  const fluoroscopy::CArmPose before = room_.geometry().pose();
  processInput([this] { advanceGantry(); });
  const bool draws = hasSubscribers() && !room_.awaitsPatient() && !room_.awaitsVessel();
  const ros::Time stamp = ros::Time::now();
  const bool is_due = (ros::SteadyTime::now() - broadcast_time_).toSec() >= kRestPeriod;
  if (draws || is_due || room_.geometry().pose() != before)
    broadcastPose(stamp);  // at frame rate too, so that an image need not wait for its pose
  if (!draws)
    frames_.pause();
  else
    processInput(
        [&]
        {
          publishFrame(stamp);
          frames_.draw(event.current_real.toSec());
        });
}

void FluoroscopyNode::publishFrame(const ros::Time& stamp)
{
  const auto begin = std::chrono::steady_clock::now();
  const bool display = radiograph_.image.getNumSubscribers() + source_view_.image.getNumSubscribers() > 0;
  const fluoroscopy::Frame& frame = room_.render(display);
  render_times_.push_back(std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count());
  air_kerma_rate_ = frame.reference_kerma * rate_;
  dose_limited_ = frame.dose_limited;
  std_msgs::Header header;
  header.stamp = stamp;
  header.frame_id = names::kXRaySourceFrame;
  radiograph_.camera_info.publish(toCameraInfo(header, room_.geometry()));
  if (radiograph_.raw.getNumSubscribers() > 0)
    radiograph_.raw.publish(toImage(header, frame.pixels, frame.raw));
  if (radiograph_.image.getNumSubscribers() > 0)
    radiograph_.image.publish(toImage(header, frame.pixels, frame.image));
  header.frame_id = names::kXRaySourceViewFrame;
  source_view_.camera_info.publish(toSourceViewInfo(header, room_.geometry()));
  if (source_view_.raw.getNumSubscribers() > 0)
    source_view_.raw.publish(mirrored(toImage(header, frame.pixels, frame.raw)));
  if (source_view_.image.getNumSubscribers() > 0)
    source_view_.image.publish(mirrored(toImage(header, frame.pixels, frame.image)));
}

void FluoroscopyNode::onDiagnostics(const ros::SteadyTimerEvent& /*event*/)
{
  publishDiagnostics(updater_);
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
  if (room_.awaitsVessel())
    status.summary(DiagnosticStatus::WARN, "waiting for the vessel");
  else if (!patient_error_.empty())
    status.summary(DiagnosticStatus::ERROR, patient_error_);
  else if (room_.awaitsPatient())
    status.summary(DiagnosticStatus::WARN,
                   "waiting for vessel/centreline, which determines the position of the patient");
  else if (!new_error_.empty())
    status.summary(DiagnosticStatus::WARN, new_error_);
  else
    status.summary(DiagnosticStatus::OK, hasSubscribers() ? "rendering" : "idle: no subscriber");
  status.add("frames rendered", frames_.drawn());
  status.add("frames left out", frames_.leftOut());
  status.add("frames per second", static_cast<double>(render_times_.size()) / kDiagnosticsPeriod);
  status.add("median render time [ms]", 1e3 * median);
  status.add("air kerma rate at the reference point [mGy/min]", 60e3 * air_kerma_rate_);
  status.add("dose limited", dose_limited_);
  const fluoroscopy::CArmPose& pose = room_.gantry().pose();
  status.add("C-arm moving", room_.gantry().isMoving());
  status.add("primary angle, LAO positive [rad]", pose.primary_angle);
  status.add("secondary angle, cranial positive [rad]", pose.secondary_angle);
  status.add("scheduling", grant_.describe());
  status.add("last error", last_error_);
  IgnoredMessages::ofProcess().diagnose(status);
  render_times_.clear();
  new_error_.clear();
}

}  // namespace endovascular_sim::nodes
