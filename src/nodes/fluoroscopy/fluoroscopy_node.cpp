#include "nodes/fluoroscopy/fluoroscopy_node.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include <ros/package.h>

#include "common/error.h"
#include "common/text/format.h"
#include "nodes/conversions/contact_conversions.h"
#include "nodes/conversions/contrast_conversions.h"
#include "nodes/conversions/image_conversions.h"
#include "nodes/conversions/message_checks.h"
#include "nodes/conversions/motion_conversions.h"
#include "nodes/conversions/treatment_conversions.h"
#include "nodes/conversions/vessel_conversions.h"
#include "nodes/runtime/diagnostics_publication.h"
#include "nodes/runtime/guarded_subscription.h"
#include "nodes/runtime/ros_names.h"
#include "simulation/local_deformable_wall.h"

namespace endovascular_sim::nodes
{
namespace
{

constexpr double kDiagnosticsPeriod = 1.0;  ///< [s]
constexpr int kStateQueue = 1000;           ///< states of the simulation, as many as it lets wait
constexpr std::size_t kStamps = 64;         ///< of poses that are not repeated
constexpr int kTicksPerPulse = 4;           ///< looks for a new pulse
constexpr int kPoseQueue = 100;             ///< of /tf, as that of tf2_ros
constexpr double kWarningPeriod = 1.0;      ///< between two warnings of the same place [s]
constexpr double kRestPeriod = 0.5;         ///< of the pose on /tf, and of images, while nothing changes [s]

/** Material library of the private parameter `materials`; by default that of the package. */
fluoroscopy::MaterialLibrary materialLibrary(const ros::NodeHandle& parameters)
{
  const std::string own = ros::package::getPath("endovascular_sim") + "/config/xray/materials.yaml";
  auto library = fluoroscopy::MaterialLibrary::load(parameters.param<std::string>("materials", own));
  for (const std::string& warning : library.warnings())
    ROS_WARN("%s", warning.c_str());
  return library;
}

const char* nameOf(fluoroscopy::MaskState state)
{
  switch (state)
  {
    case fluoroscopy::MaskState::kTaking:
      return "taking";
    case fluoroscopy::MaskState::kValid:
      return "valid";
    case fluoroscopy::MaskState::kInvalid:
      return "invalid";
    default:
      return "none";
  }
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
    time_step_(scene.solver.time_step),
    room_(scene, materialLibrary(parameters)),
    states_({rate_, time_step_}, {scene.motion.has_value(), simulation::hasBalloon(scene), scene.contrast.has_value()},
            parameters.param("follows_recording", false)),
    gantry_time_(ros::SteadyTime::now()),
    request_(std::move(request)),
    radiograph_{node.advertise<sensor_msgs::Image>(names::kFluoroscopyRaw, 2),
                node.advertise<sensor_msgs::Image>(names::kFluoroscopyImage, 2),
                node.advertise<sensor_msgs::CameraInfo>(names::kFluoroscopyCameraInfo, 2)},
    source_view_{node.advertise<sensor_msgs::Image>(names::kSourceViewRaw, 2),
                 node.advertise<sensor_msgs::Image>(names::kSourceViewImage, 2),
                 node.advertise<sensor_msgs::CameraInfo>(names::kSourceViewCameraInfo, 2)},
    dsa_(node.advertise<sensor_msgs::Image>(names::kFluoroscopyDsa, 2)),
    frame_(node.advertise<XRayFrame>(names::kFluoroscopyFrame, 2))
{
  mesh_subscriber_ = subscribeGuarded<VesselMesh>(node, names::kVesselMesh, 1,
                                                  [this](const VesselMesh& message) { receiveMesh(message); });
  if (room_.needsCentreline())
    centreline_subscriber_ = subscribeGuarded<VesselCentreline>(
        node, names::kVesselCentreline, 1, [this](const VesselCentreline& message) { receiveCentreline(message); });
  motion_subscriber_ = subscribeGuarded<MotionState>(node, names::kMotionState, kStateQueue,
                                                     [this](const MotionState& message) { receiveMotion(message); });
  if (scene.contrast)
    contrast_subscriber_ = subscribeGuarded<ContrastState>(
        node, names::kContrastState, kStateQueue, [this](const ContrastState& message) { receiveContrast(message); });
  rod_subscriber_ = subscribeGuarded<RodStateVisual>(node, names::kRodStateVisual, kStateQueue,
                                                     [this](const RodStateVisual& message) { receiveRod(message); });
  treatment_subscriber_ =
      subscribeGuarded<TreatmentVisual>(node, names::kTreatmentVisual, kStateQueue,
                                        [this](const TreatmentVisual& message) { receiveTreatment(message); });
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
  loadPatient();
  const boost::function<bool(SetXRayMode::Request&, SetXRayMode::Response&)> set_mode =
      [this](SetXRayMode::Request& request, SetXRayMode::Response& response) { return answer(request, response); };
  mode_service_ = node.advertiseService(names::kSetXRayMode, set_mode);
  gantry_timer_ = node.createSteadyTimer(ros::WallDuration(1.0 / rate_), &FluoroscopyNode::onGantry, this);
  pulse_timer_ =
      node.createSteadyTimer(ros::WallDuration(1.0 / (kTicksPerPulse * rate_)), &FluoroscopyNode::onPulse, this);
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
        room_.setCentreline(fromMessage(message), lesionsFromMessage(message));
        loadPatient();
      });
}

/** Loads the patient of the scene when mesh and centreline of its vessel are known. No frame is drawn before. */
void FluoroscopyNode::loadPatient()
{
  if (!room_.canLoadPatient())
  {
    requestScheduling(!room_.needsCentreline());
    return;
  }
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
  requestScheduling(true);
}

/** Requests the scheduling of the process, once. @param is_prepared patient and lumen are there, or never will be */
void FluoroscopyNode::requestScheduling(bool is_prepared)
{
  if (is_prepared && request_)
    grant_ = std::exchange(request_, nullptr)();
}

void FluoroscopyNode::receiveRod(const RodStateVisual& message)
{
  processInput(
      [&]
      {
        simulation::ImagedInstruments instruments = imagedInstruments(message, room_.system().instruments().size());
        room_.follow(instruments.nodes);
        if (states_.accepts(message.step + 1))
          states_.addInstruments(message.step + 1, std::move(instruments), message.header.stamp.toNSec());
      });
}

void FluoroscopyNode::receiveTreatment(const TreatmentVisual& message)
{
  if (states_.accepts(message.step + 1))
    processInput([&] { states_.addTreatment(message.step + 1, imagedTreatment(message)); });
}

void FluoroscopyNode::receiveMotion(const MotionState& message)
{
  processInput(
      [&]
      {
        if (!std::isfinite(message.diaphragm))
          throw InputError(names::kMotionState, "diaphragm", "must be finite");
        if (states_.accepts(message.step + 1))
          states_.addMotion(message.step + 1, {fromMessage(message), message.diaphragm});
      });
}

void FluoroscopyNode::receiveContrast(const ContrastState& message)
{
  if (states_.accepts(message.step + 1))
    processInput([&] { states_.addContrast(message.step + 1, mediumOf(message)); });
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
  if (has_recorded_pose_ ||
      std::find(broadcast_stamps_.begin(), broadcast_stamps_.end(), stamp) != broadcast_stamps_.end())
    return;
  broadcast_stamps_.push_back(stamp);
  if (broadcast_stamps_.size() > kStamps)
    broadcast_stamps_.pop_front();
  pose_.transforms = {toTransform(stamp, room_.geometry())};
  pose_publisher_.publish(pose_);
  broadcast_time_ = ros::SteadyTime::now();
}

bool FluoroscopyNode::hasSubscribers() const
{
  return radiograph_.hasSubscribers() || source_view_.hasSubscribers() || dsa_.getNumSubscribers() > 0;
}

void FluoroscopyNode::onGantry(const ros::SteadyTimerEvent& /*event*/)
{
  const fluoroscopy::CArmPose before = room_.geometry().pose();
  processInput([this] { advanceGantry(); });
  const bool is_due = (ros::SteadyTime::now() - broadcast_time_).toSec() >= kRestPeriod;
  if (is_due || room_.geometry().pose() != before)
    broadcastPose(ros::Time::now());
}

void FluoroscopyNode::onPulse(const ros::SteadyTimerEvent& /*event*/)
{
  if (!hasSubscribers() || room_.awaitsPatient() || room_.awaitsVessel())
    frames_.pause();
  else
    processInput([this] { drawFrame(); });
}

/** Takes over the state of the pulse that is to be drawn next.
 *  @return stamp of its images, that of the state; empty without a new one */
std::optional<ros::Time> FluoroscopyNode::takePulse()
{
  const std::optional<ImagedState> state = states_.take(room_.angiography().takesMask());
  if (!state)
    return std::nullopt;
  room_.setState(*state);
  pulse_ = state->pulse;
  steps_ = state->steps;
  if (state->stamp == 0)
    return ros::Time::now();
  // An image that was drawn again meanwhile may be newer: images of a run have ascending stamps.
  const ros::Time stamp = ros::Time().fromNSec(state->stamp);
  const bool is_passed = stamp <= image_stamp_ && image_stamp_ - stamp < ros::Duration(kRestPeriod);
  return is_passed ? image_stamp_ + ros::Duration(0, 1) : stamp;
}

/** True if the last pulse is to be drawn again: its image would change, or viewers wait for one. */
bool FluoroscopyNode::isDueAgain() const
{
  const fluoroscopy::Angiography& angiography = room_.angiography();
  if (angiography.takesMask())
    return false;
  const double since = (ros::SteadyTime::now() - draw_time_).toSec();
  const bool changes =
      angiography.mode() != fluoroscopy::XRayMode::kHold &&
      (angiography.last() == nullptr || !angiography.last()->native.complete || draw_pose_ != room_.geometry().pose());
  return since >= (changes ? 1.0 / rate_ : kRestPeriod);
}

void FluoroscopyNode::drawFrame()
{
  const bool is_held = room_.angiography().mode() == fluoroscopy::XRayMode::kHold;
  const std::optional<ros::Time> new_pulse = is_held ? std::nullopt : takePulse();
  if (!new_pulse && !isDueAgain())
    return;
  const ros::Time stamp = new_pulse.value_or(ros::Time::now());
  image_stamp_ = stamp;
  draw_time_ = ros::SteadyTime::now();
  broadcastPose(stamp);  // so that an image need not wait for its pose
  if (is_held)
  {
    if (room_.angiography().last() != nullptr)
      publishFrame(*room_.angiography().last(), stamp);
    return;
  }
  draw_pose_ = room_.geometry().pose();
  // A frame that is held later needs its image.
  const fluoroscopy::AngiographyFrame& frame = room_.draw(pulse_, true);
  render_times_.push_back((ros::SteadyTime::now() - draw_time_).toSec());
  air_kerma_rate_ = frame.native.reference_kerma * rate_;
  dose_limited_ = frame.native.dose_limited;
  publishFrame(frame, stamp);
  frames_.draw(pulse_);
}

void FluoroscopyNode::publishFrame(const fluoroscopy::AngiographyFrame& frame, const ros::Time& stamp)
{
  const fluoroscopy::Frame& native = frame.native;
  std_msgs::Header header;
  header.stamp = stamp;
  header.frame_id = names::kXRaySourceFrame;
  XRayFrame message;
  message.header = header;
  message.pulse = frame.pulse;
  message.steps = steps_;
  message.time = static_cast<double>(steps_) * time_step_;
  message.mode = fluoroscopy::nameOf(room_.angiography().mode());
  message.complete = native.complete ? 1 : 0;
  message.tube_charge = native.tube_charge;
  message.reference_kerma = native.reference_kerma;
  message.mask = nameOf(frame.mask);
  message.remark = frame.remark;
  frame_.publish(message);
  radiograph_.camera_info.publish(toCameraInfo(header, room_.geometry()));
  if (radiograph_.raw.getNumSubscribers() > 0)
    radiograph_.raw.publish(toImage(header, native.pixels, native.raw));
  if (radiograph_.image.getNumSubscribers() > 0)
    radiograph_.image.publish(toImage(header, native.pixels, native.image));
  if (dsa_.getNumSubscribers() > 0 && !frame.subtracted.empty())
    dsa_.publish(toImage(header, native.pixels, frame.subtracted));
  header.frame_id = names::kXRaySourceViewFrame;
  source_view_.camera_info.publish(toSourceViewInfo(header, room_.geometry()));
  if (source_view_.raw.getNumSubscribers() > 0)
    source_view_.raw.publish(mirrored(toImage(header, native.pixels, native.raw)));
  if (source_view_.image.getNumSubscribers() > 0)
    source_view_.image.publish(mirrored(toImage(header, native.pixels, native.image)));
}

void FluoroscopyNode::setMode(const SetXRayMode::Request& request)
{
  fluoroscopy::Angiography& angiography = room_.angiography();
  const Eigen::Vector2d shift = angiography.shift();
  const double share = angiography.share();
  try
  {
    angiography.setShift({request.shift_columns, request.shift_rows});
    if (request.share != 0.0)
      angiography.setShare(request.share);
    if (request.mode.empty())
    {
      if (request.mask_frames > 0)
        throw InputError(names::kSetXRayMode, "mode", "is empty; give dsa to take a mask");
      return;
    }
    const auto mask_frames = static_cast<int>(std::min<std::uint32_t>(request.mask_frames, 1000));
    angiography.begin(fluoroscopy::xRayModeOf(request.mode), mask_frames);
  }
  catch (const InputError&)
  {
    angiography.setShift(shift);
    angiography.setShare(share);
    throw;
  }
  if (angiography.takesMask())
    states_.take(false);  // a mask begins with a pulse after the call
}

bool FluoroscopyNode::answer(const SetXRayMode::Request& request, SetXRayMode::Response& response)
{
  try
  {
    setMode(request);
    const fluoroscopy::Angiography& angiography = room_.angiography();
    response.success = 1;
    response.message = formatted("%s, shift of the mask (%g, %g) pixels, share of the roadmap %g",
                                 fluoroscopy::nameOf(angiography.mode()), angiography.shift().x(),
                                 angiography.shift().y(), angiography.share());
  }
  catch (const InputError& error)
  {
    ROS_WARN("refused a mode of fluoroscopy: %s", error.what());
    response.success = 0;
    response.message = error.what();
  }
  return true;
}

/** Message of the diagnostics without a fault. */
std::string FluoroscopyNode::summary() const
{
  if (!hasSubscribers())
    return "idle: no subscriber";
  const fluoroscopy::AngiographyFrame* last = room_.angiography().last();
  if (last != nullptr && last->mask == fluoroscopy::MaskState::kInvalid)
    return last->remark;
  return "rendering";
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
    status.summary(DiagnosticStatus::OK, summary());
  const fluoroscopy::AngiographyFrame* last = room_.angiography().last();
  status.add("mode", fluoroscopy::nameOf(room_.angiography().mode()));
  status.add("mask", last != nullptr ? nameOf(last->mask) : "none");
  status.add("remark", last != nullptr ? last->remark : "");
  status.add("pulse", pulse_);
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
