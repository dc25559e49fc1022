#include "nodes/session/recorded_topics.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <utility>

#include <crtk_msgs/OperatingState.h>
#include <crtk_msgs/StringStamped.h>
#include <sensor_msgs/FluidPressure.h>
#include <sensor_msgs/JointState.h>
#include <sensor_msgs/image_encodings.h>
#include <std_msgs/String.h>
#include <tf2_msgs/TFMessage.h>
#include <boost/make_shared.hpp>

#include "common/error.h"
#include "common/hash.h"
#include "common/text/format.h"
#include "common/version.h"
#include "endovascular_sim/BloodFlow.h"
#include "endovascular_sim/CArm.h"
#include "endovascular_sim/ContrastCells.h"
#include "endovascular_sim/ContrastInjection.h"
#include "endovascular_sim/FlowNetwork.h"
#include "endovascular_sim/GetVessel.h"
#include "endovascular_sim/HeartPhase.h"
#include "endovascular_sim/HemodynamicControls.h"
#include "endovascular_sim/MotionControls.h"
#include "endovascular_sim/ProcedureStep.h"
#include "endovascular_sim/SensorReading.h"
#include "endovascular_sim/SessionEnd.h"
#include "endovascular_sim/SessionGap.h"
#include "endovascular_sim/SessionMark.h"
#include "endovascular_sim/SessionSample.h"
#include "endovascular_sim/SimulationRun.h"
#include "endovascular_sim/TreatmentVisual.h"
#include "endovascular_sim/WallDisplacement.h"
#include "fluoroscopy/image/png_writer.h"
#include "intervention/wall_displacement.h"
#include "nodes/conversions/contrast_conversions.h"
#include "nodes/conversions/message_checks.h"
#include "nodes/conversions/motion_conversions.h"
#include "nodes/conversions/vessel_conversions.h"
#include "nodes/runtime/guarded_subscription.h"
#include "nodes/runtime/ros_names.h"
#include "nodes/session/private_text.h"
#include "nodes/session/recorded_pictures.h"
#include "nodes/session/session_identity.h"
#include "scene/model/portable_text.h"

namespace endovascular_sim::nodes
{
namespace
{

constexpr std::uint32_t kQueue = 1000;
constexpr double kMapBytes = 10e3;  ///< size of contact/force_map in a second of the bag [B/s]
/** Steps per metre or newton of positions and forces for display, in the bag: a wire at rest then has equal bytes,
 * which the compression removes. A step is 0.95 µm or 0.95 µN. */
constexpr double kGrid = 1048576.0;
constexpr double kLinkTime = 0.5;  ///< time after which a connection without a message is complete [s]

template <typename Vector>
void roundToGrid(Vector& vector)
{
  for (double* value : {&vector.x, &vector.y, &vector.z})
    *value = std::round(*value * kGrid) / kGrid + 0.0;  // + 0.0: no negative zero
}

/** Copy of a state with positions and forces rounded to the grid. The position of the tip is not rounded: the report
 *  contains it. */
boost::shared_ptr<RodStateVisual> rounded(const RodStateVisual& state)
{
  const auto copy = boost::make_shared<RodStateVisual>(state);
  for (std::size_t k = 0; k + 1 < copy->nodes.size(); ++k)
    roundToGrid(copy->nodes[k]);
  for (geometry_msgs::Vector3& force : copy->contact_force)
    roundToGrid(force);
  return copy;
}

boost::shared_ptr<ContactForces> rounded(const ContactForces& forces)
{
  const auto copy = boost::make_shared<ContactForces>(forces);
  for (ContactForce& contact : copy->contacts)
  {
    roundToGrid(contact.position);
    roundToGrid(contact.normal_force);
    roundToGrid(contact.friction_force);
  }
  return copy;
}

/** Event with another message in place of its own. */
template <typename Message>
ros::MessageEvent<Message const> withMessage(const ros::MessageEvent<Message const>& event,
                                             const boost::shared_ptr<Message>& message)
{
  return {message, event.getConnectionHeaderPtr(), event.getReceiptTime(), true, ros::DefaultMessageCreator<Message>()};
}

/** Event for the bag, whose texts name neither user, host nor folder. */
template <typename Message>
ros::MessageEvent<Message const> recorded(const ros::MessageEvent<Message const>& event)
{
  return event;
}

template <>
ros::MessageEvent<crtk_msgs::StringStamped const> recorded(
    const ros::MessageEvent<crtk_msgs::StringStamped const>& event)
{
  const auto message = boost::make_shared<crtk_msgs::StringStamped>(*event.getConstMessage());
  message->string = PrivateText::ofProcess().removedFrom(message->string);
  return withMessage(event, message);
}

template <>
ros::MessageEvent<diagnostic_msgs::DiagnosticArray const> recorded(
    const ros::MessageEvent<diagnostic_msgs::DiagnosticArray const>& event)
{
  const PrivateText& texts = PrivateText::ofProcess();
  const auto message = boost::make_shared<diagnostic_msgs::DiagnosticArray>(*event.getConstMessage());
  for (diagnostic_msgs::DiagnosticStatus& status : message->status)
  {
    for (std::string* text : {&status.name, &status.message, &status.hardware_id})
      *text = texts.removedFrom(*text);
    for (diagnostic_msgs::KeyValue& value : status.values)
      value.value = withoutFolder(texts.removedFrom(value.value));
  }
  return withMessage(event, message);
}

template <>
ros::MessageEvent<VesselMesh const> recorded(const ros::MessageEvent<VesselMesh const>& event)
{
  const std::string source = withoutFolder(event.getConstMessage()->source);
  if (source == event.getConstMessage()->source)
    return event;
  const auto message = boost::make_shared<VesselMesh>(*event.getConstMessage());
  message->source = source;
  return withMessage(event, message);
}

}  // namespace

RecordedTopics::RecordedTopics(const ros::NodeHandle& node, const scene::Scene& scene, int picture_interval,
                               StepSequence& sequence, const std::string& subject)
  : node_(node),
    scene_(scene),
    picture_interval_(picture_interval),
    sequence_(sequence),
    info_(infoOf(scene, subject)),
    last_step_(ros::SteadyTime::now()),
    info_publisher_(node_.advertise<SessionInfo>(names::kSessionInfo, 1, true))
{
  if (!scene_.vessel)
    publishInfo();
  subscribeToWire();
  if (scene_.vessel)
    subscribeToVessel();
  if (scene_.fluoroscopy)
    subscribeToFluoroscopy();
  if (scene_.flow)
    subscribeToBlood();
  if (scene_.contrast)
    subscribeToContrast();
  if (scene_.motion)
    subscribeToMotion();
  subscribeToGraph();
}

bool RecordedTopics::isConnected()
{
  const ros::SteadyTime now = ros::SteadyTime::now();
  if (linked_.isZero() && steps_.getNumPublishers() > 0)
    linked_ = now;
  return info_published_ && (has_steps_ || (!linked_.isZero() && (now - linked_).toSec() > kLinkTime));
}

SessionInfo RecordedTopics::recordedInfo() const
{
  SessionInfo info = info_;
  info.first_step = place_.first_step;
  info.continues = place_.continues;
  return info;
}

void RecordedTopics::recordInto(Recording* recording, const BagPlace& place)
{
  recording_ = recording;
  place_ = place;
  is_waiting_ = false;
  recording->results.report().setSubject(info_.subject);
  if (info_published_)
    recording->bag.writeLatched(node_.resolveName(names::kSessionInfo), recordedInfo());
  for (const auto& [key, begin] : latched_)
    begin(*recording);
}

template <typename Message>
void RecordedTopics::listen(const std::string& topic, std::uint32_t queue,
                            std::function<void(const ros::MessageEvent<Message const>&)> callback)
{
  subscribers_.push_back(subscribeGuarded<Message>(node_, topic, queue, std::move(callback)));
}

template <typename Message>
void RecordedTopics::record(const std::string& topic, std::uint32_t queue)
{
  const std::string resolved = node_.resolveName(topic);
  listen<Message>(topic, queue,
                  [this, resolved](const ros::MessageEvent<Message const>& event)
                  {
                    if (recording_ != nullptr)
                      recording_->bag.write(resolved, event);
                  });
}

template <typename Message>
void RecordedTopics::recordLatched(const std::string& topic, std::uint32_t queue)
{
  const std::string resolved = node_.resolveName(topic);
  listen<Message>(topic, queue,
                  [this, resolved](const ros::MessageEvent<Message const>& received)
                  {
                    const ros::MessageEvent<Message const> event = recorded(received);
                    if (recording_ != nullptr)
                      recording_->bag.write(resolved, event);
                    latched_[{Rank::kOther, resolved + " " + event.getPublisherName()}] =
                        [resolved, event](Recording& recording)
                    { recording.bag.write(resolved, ros::Time::now(), event); };
                  });
}

template <typename Message>
void RecordedTopics::recordThrottled(const std::string& topic, std::uint32_t queue, Throttle Recording::*rate)
{
  const std::string resolved = node_.resolveName(topic);
  listen<Message>(topic, queue,
                  [this, resolved, rate](const ros::MessageEvent<Message const>& event)
                  {
                    if (recording_ != nullptr && (recording_->*rate).passes(event.getConstMessage()->time))
                      recording_->bag.write(resolved, event);
                  });
}

template <typename Message>
void RecordedTopics::measure(const std::string& topic, std::uint32_t queue)
{
  const std::string resolved = node_.resolveName(topic);
  listen<Message>(topic, queue,
                  [this, resolved](const ros::MessageEvent<Message const>& event)
                  {
                    if (recording_ == nullptr || sequence_.isBefore(*event.getMessage()))
                      return;
                    sequence_.requireKnown(*event.getMessage(), resolved);
                    recording_->results.metrics().add(*event.getMessage());  // throws for an invalid one
                    recording_->bag.write(resolved, event);
                  });
}

template <typename Message>
void RecordedTopics::recordJoints(const char* topic, const Message& message, ros::Time time)
{
  const std::size_t hands = std::min({scene_.instruments.size(), message.insertion.size(), message.rotation.size(),
                                      message.pressure.size(), message.hand_force.size(), message.hand_torque.size()});
  for (std::size_t k = 0; k < hands; ++k)
  {
    const instrument::Instrument& instrument = scene_.instruments[k].instrument;
    const auto joints = boost::make_shared<sensor_msgs::JointState>();
    joints->header.stamp = message.header.stamp;
    joints->header.frame_id = names::kIntroducerFrame;
    toMessage(instrument.balloon.has_value(), {message.insertion[k], message.rotation[k], message.pressure[k]},
              message.hand_force[k], message.hand_torque[k], *joints);
    recording_->bag.write(node_.resolveName(names::kInstruments + instrument.name + topic), time, joints);
  }
}

void RecordedTopics::subscribeToWire()
{
  listen<SessionSteps>(names::kSessionSteps, kStepQueue, [this](const auto& event) { onSteps(event); });
  steps_ = subscribers_.back();
  listen<RodStateVisual>(names::kRodStateVisual, kQueue, [this](const auto& event) { onRod(event); });
  states_ = subscribers_.back();
  measure<TreatmentVisual>(names::kTreatmentVisual, kQueue);
  for (const scene::DrivenInstrument& driven : scene_.instruments)
  {
    const std::string instrument = names::kInstruments + driven.instrument.name;
    recordLatched<crtk_msgs::OperatingState>(instrument + names::kOperatingState, kQueue);
    recordLatched<crtk_msgs::StringStamped>(instrument + names::kStateReason, kQueue);
  }
  for (const sensor::SensorSettings& sensor : scene_.sensors)
    record<SensorReading>(names::kSensors + sensor.name, kStepQueue);
}

void RecordedTopics::subscribeToVessel()
{
  listen<VesselMesh>(names::kVesselMesh, 1, [this](const auto& event) { onVessel(event); });
  listen<VesselCentreline>(names::kVesselCentreline, 1, [this](const auto& event) { onCentreline(event); });
  measure<WallDisplacement>(names::kWallDisplacement, kStepQueue);
  if (scene_.procedure)
    measure<ProcedureStep>(names::kProcedureStep, kStepQueue);
  measure<SessionSample>(names::kSessionSample, kStepQueue);
  listen<ContactForces>(names::kContactForces, kQueue, [this](const auto& event) { onContacts(event); });
  listen<ContactForceMap>(names::kContactForceMap, kQueue, [this](const auto& event) { onForceMap(event); });
}

void RecordedTopics::subscribeToFluoroscopy()
{
  listen<sensor_msgs::Image>(names::kFluoroscopyImage, 10, [this](const auto& event) { onImage(event); });
  listen<sensor_msgs::CameraInfo>(names::kFluoroscopyCameraInfo, 10,
                                  [this](const auto& event) { onCameraInfo(event); });
  record<CArm>(names::kCArmCommand, kQueue);
}

void RecordedTopics::subscribeToBlood()
{
  recordLatched<FlowNetwork>(names::kFlowNetwork, 1);
  recordLatched<HemodynamicControls>(names::kHemodynamicControls, kQueue);
  record<sensor_msgs::FluidPressure>(names::kTipPressure, kStepQueue);
  listen<HeartPhase>(
      names::kHeartPhase, kStepQueue,
      [this, topic = node_.resolveName(names::kHeartPhase)](const ros::MessageEvent<HeartPhase const>& event)
      {
        if (recording_ == nullptr)
          return;
        recording_->results.metrics().add(*event.getMessage());
        if (recording_->heart.passes(event.getMessage()->time))
          recording_->bag.write(topic, event);
      });
  recordThrottled<BloodFlow>(names::kBloodFlow, kQueue, &Recording::flow);
}

void RecordedTopics::subscribeToMotion()
{
  recordLatched<MotionControls>(names::kMotionControls, kQueue);
  listen<MotionState>(names::kMotionState, kQueue,
                      [this](const ros::MessageEvent<MotionState const>& event)
                      {
                        if (recording_ == nullptr)
                          return;
                        fromMessage(*event.getConstMessage());  // throws for an invalid one
                        onPosePart(names::kMotionState, event, &Recording::motions);
                      });
}

void RecordedTopics::subscribeToContrast()
{
  recordLatched<ContrastCells>(names::kContrastCells, 1);
  recordLatched<ContrastInjection>(names::kContrastInjection, kQueue);
  listen<ContrastState>(names::kContrastState, kQueue,
                        [this](const ros::MessageEvent<ContrastState const>& event)
                        {
                          if (recording_ == nullptr)
                            return;
                          mediumOf(*event.getConstMessage());  // throws for an invalid one
                          onPosePart(names::kContrastState, event, &Recording::contrasts);
                        });
}

void RecordedTopics::subscribeToGraph()
{
  if (scene_.robot)
    recordLatched<std_msgs::String>(names::kRobotDescriptionTopic, 1);
  listen<diagnostic_msgs::DiagnosticArray>(names::kDiagnostics, kQueue,
                                           [this](const auto& event) { onDiagnostics(event); });
  record<tf2_msgs::TFMessage>("/tf", kStepQueue);
  recordLatched<tf2_msgs::TFMessage>("/tf_static", kQueue);
}

void RecordedTopics::publishInfo()
{
  if (info_published_)
    return;
  info_published_ = true;
  info_.header.stamp = ros::Time::now();
  info_publisher_.publish(info_);
  if (recording_ != nullptr)
    recording_->bag.writeLatched(node_.resolveName(names::kSessionInfo), recordedInfo());
}

void RecordedTopics::setSubject(const std::string& subject)
{
  info_.subject = subject;
  if (recording_ != nullptr)
    recording_->results.report().setSubject(subject);
  if (!info_published_)
    return;
  info_publisher_.publish(info_);
  if (recording_ != nullptr)
    recording_->bag.writeLatched(node_.resolveName(names::kSessionInfo), info_);
}

void RecordedTopics::onSteps(const ros::MessageEvent<SessionSteps const>& event)
{
  const SessionStepsConstPtr group = event.getConstMessage();
  if (group->steps.empty())
    throw InputError(names::kSessionSteps, "steps", "is empty");
  for (std::size_t k = 0; k < group->steps.size(); ++k)
  {
    requireUsable(group->steps[k], scene_.instruments.size());
    if (group->steps[k].step != group->steps.front().step + k)
      throw InputError(names::kSessionSteps, "steps", "do not follow each other");
  }
  has_steps_ = true;
  if (is_waiting_ || group->steps.back().step < sequence_.first())
    return;
  sequence_.accept(*group, event.getPublisherName());
  for (const DriveApplied& step : group->steps)
    recordStep(boost::shared_ptr<const DriveApplied>(group, &step), event.getReceiptTime());
}

void RecordedTopics::recordStep(const DriveAppliedConstPtr& step, ros::Time time)
{
  sequence_.setHandled(step->step + 1);
  if (recording_ == nullptr || recording_->isComplete())
    return;
  recording_->results.add(*step);
  last_step_ = ros::SteadyTime::now();
  recording_->bag.write(node_.resolveName(names::kDriveApplied), time, step);
  if (recording_->joints.passes(static_cast<double>(step->step) * scene_.solver.time_step))
    recordJoints(names::kSetpointJs, *step, time);
}

void RecordedTopics::onRod(const ros::MessageEvent<RodStateVisual const>& event)
{
  if (recording_ == nullptr)
    return;
  const RodStateVisual& rod = *event.getMessage();
  if (sequence_.isBefore(rod))
    return;
  sequence_.requireKnown(rod, names::kRodStateVisual);
  requireUsable(rod, scene_.instruments.size());
  recordJoints(names::kMeasuredJs, rod, event.getReceiptTime());
  recording_->newest_pose = event;
  if (recording_->pose.passes(rod.time))
    recordNewestPose(*recording_);
}

void RecordedTopics::recordNewestPose(Recording& recording) const
{
  if (!recording.newest_pose)
    return;
  recording.results.add(*recording.newest_pose->getConstMessage());
  if (recording.error.empty())
    recording.error = recording.results.trajectoryError();
  const auto& pose = *recording.newest_pose;
  recording.pose_step = pose.getConstMessage()->step;
  recordPosePart(names::kMotionState, recording, &Recording::motions);
  recordPosePart(names::kContrastState, recording, &Recording::contrasts);
  recording.bag.write(node_.resolveName(names::kRodStateVisual), withMessage(pose, rounded(*pose.getConstMessage())));
  recording.newest_pose.reset();
}

template <typename Message>
void RecordedTopics::onPosePart(const char* topic, const ros::MessageEvent<Message const>& event,
                                PoseParts<Message> Recording::*parts)
{
  const Message& message = *event.getConstMessage();
  if (sequence_.isBefore(message))
    return;
  sequence_.requireKnown(message, topic);
  PoseParts<Message>& waiting = recording_->*parts;
  waiting[message.step] = event;
  if (waiting.size() > kQueue)
    waiting.erase(waiting.begin());
  if (recording_->pose_step == message.step)  // it has arrived after the pose of its step
    recordPosePart(topic, *recording_, parts);
}

/** Records the part of the last recorded pose, and forgets those of the poses before, which are left out. */
template <typename Message>
void RecordedTopics::recordPosePart(const char* topic, Recording& recording, PoseParts<Message> Recording::*parts) const
{
  PoseParts<Message>& waiting = recording.*parts;
  const auto part = waiting.find(*recording.pose_step);
  if (part == waiting.end())
    return;
  recording.bag.write(node_.resolveName(topic), part->second);
  waiting.erase(waiting.begin(), std::next(part));
}

void RecordedTopics::onContacts(const ros::MessageEvent<ContactForces const>& event)
{
  if (recording_ == nullptr)
    return;
  const ContactForces& forces = *event.getMessage();
  if (sequence_.isBefore(forces))
    return;
  sequence_.requireKnown(forces, names::kContactForces);
  requireUsable(forces);
  if (recording_->contacts.passes(static_cast<double>(forces.step) * scene_.solver.time_step))
    recording_->bag.write(node_.resolveName(names::kContactForces), withMessage(event, rounded(forces)));
}

void RecordedTopics::onForceMap(const ros::MessageEvent<ContactForceMap const>& event)
{
  if (recording_ == nullptr)
    return;
  sequence_.requireKnown(*event.getConstMessage(), names::kContactForceMap);
  requireUsable(*event.getConstMessage());
  recording_->results.add(event.getConstMessage());
  if (event.getConstMessage()->step >= recording_->steps)
    return;  // after the session's last step, as in the results
  recording_->newest_map = event;
  if (event.getConstMessage()->time >= recording_->next_map || event.getConstMessage()->time < recording_->last_map)
    recordNewestMap(*recording_);
}

/** Every map holds the forces since the first step, so that earlier ones can be left out: the interval grows with its
 * size. */
void RecordedTopics::recordNewestMap(Recording& recording) const
{
  if (!recording.newest_map)
    return;
  const ContactForceMap& map = *recording.newest_map->getConstMessage();
  recording.last_map = map.time;
  recording.next_map = map.time + static_cast<double>(ros::serialization::serializationLength(map)) / kMapBytes;
  recording.bag.write(node_.resolveName(names::kContactForceMap), *recording.newest_map);
  recording.newest_map.reset();
}

void RecordedTopics::onVessel(const ros::MessageEvent<VesselMesh const>& received)
{
  if (info_published_)
    return;  // later meshes are in vessel/wall_displacement already
  const ros::MessageEvent<VesselMesh const> event = recorded(received);
  fromMessage(*event.getConstMessage());  // throws for an invalid one
  info_.mesh_hash = event.getConstMessage()->content_hash;
  initial_wall_ = event.getConstMessage();
  publishInfo();
  const std::string topic = node_.resolveName(names::kVesselMesh);
  auto& begin = latched_[{Rank::kMesh, topic}] = [topic, event](Recording& recording)
  {
    recording.results.add(event.getConstMessage());
    recording.bag.write(topic, ros::Time::now(), event);
  };
  if (recording_ != nullptr)
    begin(*recording_);
}

void RecordedTopics::recordWall(std::uint64_t first_step)
{
  GetVessel vessel;
  if (recording_ == nullptr || !initial_wall_ || !ros::service::call(node_.resolveName(names::kGetVessel), vessel))
    return;
  geometry::TriangleMesh wall = fromMessage(vessel.response.mesh);
  for (const WallDisplacement& moved : vessel.response.moved)
    intervention::move(fromMessage(moved, wall.vertices.size()), wall.vertices);
  WallDisplacement before;
  toMessage(intervention::displacementBetween(fromMessage(*initial_wall_).vertices, wall.vertices), before);
  if (before.index.empty())
    return;
  before.header.stamp = ros::Time::now();
  before.header.frame_id = names::kPatientFrame;
  before.step = first_step;
  before.version = vessel.response.mesh.version + vessel.response.moved.size();
  before.at_risk = vessel.response.at_risk;
  recording_->results.metrics().add(before);
  recording_->bag.write(node_.resolveName(names::kWallDisplacement), ros::Time::now(),
                        boost::make_shared<WallDisplacement>(before));
}

void RecordedTopics::onCentreline(const ros::MessageEvent<VesselCentreline const>& event)
{
  fromMessage(*event.getConstMessage());  // throws for an invalid one
  lesionsFromMessage(*event.getConstMessage());
  const std::string topic = node_.resolveName(names::kVesselCentreline);
  auto& begin = latched_[{Rank::kCentreline, topic}] = [topic, event](Recording& recording)
  {
    recording.results.add(*event.getConstMessage());
    recording.bag.write(topic, ros::Time::now(), event);
  };
  if (recording_ != nullptr)
    begin(*recording_);
}

/** Every frame has one such message, also where its image is not recorded. */
void RecordedTopics::onCameraInfo(const ros::MessageEvent<sensor_msgs::CameraInfo const>& event)
{
  if (recording_ == nullptr)
    return;
  recording_->results.report().addFluoroscopyFrame();
  recording_->bag.write(node_.resolveName(names::kFluoroscopyCameraInfo), event);
}

void RecordedTopics::onImage(const ros::MessageEvent<sensor_msgs::Image const>& event)
{
  if (recording_ == nullptr)
    return;
  requireUsable(*event.getConstMessage());
  if (scene_.record.x_ray_frames)
    recording_->bag.write(node_.resolveName(names::kFluoroscopyImage), event);
  if (picture_interval_ > 0 && recording_->frames++ % static_cast<std::uint64_t>(picture_interval_) == 0)
    savePicture(event.getMessage());
}

void RecordedTopics::savePicture(const sensor_msgs::ImageConstPtr& image)
{
  if (image->encoding != sensor_msgs::image_encodings::MONO8 || image->step != image->width)
    return;
  recording_->results.report().addFluoroscopyPictures(1);
  const std::string file = recording_->path("fluoroscopy/") + pictureName(recording_->frames - 1);
  recording_->bag.run(
      [image, file]
      { fluoroscopy::writePng(file, static_cast<int>(image->width), static_cast<int>(image->height), image->data); });
}

void RecordedTopics::onDiagnostics(const ros::MessageEvent<diagnostic_msgs::DiagnosticArray const>& received)
{
  if (recording_ == nullptr)
    return;
  const ros::MessageEvent<diagnostic_msgs::DiagnosticArray const> event = recorded(received);
  recording_->results.add(*event.getMessage());
  recording_->bag.write(node_.resolveName(names::kDiagnostics), event);
}

}  // namespace endovascular_sim::nodes
