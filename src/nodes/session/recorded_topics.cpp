#include "nodes/session/recorded_topics.h"

#include <algorithm>
#include <limits>
#include <utility>

#include <crtk_msgs/OperatingState.h>
#include <crtk_msgs/StringStamped.h>
#include <sensor_msgs/CameraInfo.h>
#include <sensor_msgs/JointState.h>
#include <sensor_msgs/image_encodings.h>
#include <tf2_msgs/TFMessage.h>
#include <boost/make_shared.hpp>

#include "common/error.h"
#include "common/text/format.h"
#include "common/version.h"
#include "endovascular_sim/CArm.h"
#include "endovascular_sim/GetVessel.h"
#include "endovascular_sim/ProcedureStep.h"
#include "endovascular_sim/SensorReading.h"
#include "endovascular_sim/SessionSample.h"
#include "endovascular_sim/TreatmentVisual.h"
#include "endovascular_sim/WallDisplacement.h"
#include "fluoroscopy/image/png_writer.h"
#include "intervention/wall_displacement.h"
#include "nodes/conversions/message_checks.h"
#include "nodes/conversions/vessel_conversions.h"
#include "nodes/runtime/guarded_subscription.h"
#include "nodes/runtime/ros_names.h"

namespace endovascular_sim::nodes
{
namespace
{

constexpr std::uint32_t kQueue = 1000;

SessionInfo infoOf(const scene::Scene& scene)
{
  SessionInfo info;
  info.scene_name = scene.name;
  info.scene_yaml = scene.resolved_yaml;
  info.scene_hash = scene.hash();
  info.seed = scene.seed;
  info.time_step = scene.solver.time_step;
  info.software_version = version();
  info.commit = commit();
  info.physics_number = kPhysicsNumber;
  return info;
}

}  // namespace

RecordedTopics::RecordedTopics(const ros::NodeHandle& node, const scene::Scene& scene, int picture_interval,
                               StepSequence& sequence)
  : node_(node),
    scene_(scene),
    picture_interval_(picture_interval),
    sequence_(sequence),
    info_(infoOf(scene)),
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
  subscribeToGraph();
}

void RecordedTopics::recordInto(Recording* recording)
{
  recording_ = recording;
  if (recording == nullptr)
    return;
  if (info_published_)
    recording->bag.writeLatched(node_.resolveName(names::kSessionInfo), info_);
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
                  [this, resolved](const ros::MessageEvent<Message const>& event)
                  {
                    if (recording_ != nullptr)
                      recording_->bag.write(resolved, event);
                    latched_[{Rank::kOther, resolved + " " + event.getPublisherName()}] =
                        [resolved, event](Recording& recording)
                    { recording.bag.write(resolved, ros::Time::now(), event); };
                  });
}

template <typename Message>
void RecordedTopics::measure(const std::string& topic, std::uint32_t queue)
{
  const std::string resolved = node_.resolveName(topic);
  listen<Message>(topic, queue,
                  [this, resolved](const ros::MessageEvent<Message const>& event)
                  {
                    if (recording_ == nullptr)
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
  listen<RodStateVisual>(names::kRodStateVisual, kQueue, [this](const auto& event) { onRod(event); });
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
  record<sensor_msgs::CameraInfo>(names::kFluoroscopyCameraInfo, 10);
  record<CArm>(names::kCArmCommand, kQueue);
}

void RecordedTopics::subscribeToGraph()
{
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
  sequence_.requireKnown(rod, names::kRodStateVisual);
  requireUsable(rod, scene_.instruments.size());
  recording_->results.add(rod);
  if (recording_->error.empty())
    recording_->error = recording_->results.trajectoryError();
  recordJoints(names::kMeasuredJs, rod, event.getReceiptTime());
  if (recording_->pose.passes(rod.time))
    recording_->bag.write(node_.resolveName(names::kRodStateVisual), event);
}

void RecordedTopics::onContacts(const ros::MessageEvent<ContactForces const>& event)
{
  if (recording_ == nullptr)
    return;
  const ContactForces& forces = *event.getMessage();
  sequence_.requireKnown(forces, names::kContactForces);
  requireUsable(forces);
  if (recording_->contacts.passes(static_cast<double>(forces.step) * scene_.solver.time_step))
    recording_->bag.write(node_.resolveName(names::kContactForces), event);
}

void RecordedTopics::onForceMap(const ros::MessageEvent<ContactForceMap const>& event)
{
  if (recording_ == nullptr)
    return;
  sequence_.requireKnown(*event.getConstMessage(), names::kContactForceMap);
  requireUsable(*event.getConstMessage());
  recording_->results.add(event.getConstMessage());
  recording_->bag.write(node_.resolveName(names::kContactForceMap), event);
}

void RecordedTopics::onVessel(const ros::MessageEvent<VesselMesh const>& event)
{
  if (info_published_)
    return;                               // later meshes are in vessel/wall_displacement already
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

void RecordedTopics::onImage(const ros::MessageEvent<sensor_msgs::Image const>& event)
{
  if (recording_ == nullptr)
    return;
  requireUsable(*event.getConstMessage());
  recording_->results.report().addFluoroscopyFrame();
  if (scene_.record.x_ray_frames)
    recording_->bag.write(node_.resolveName(names::kFluoroscopyImage), event);
  if (picture_interval_ > 0 && recording_->frames++ % static_cast<std::uint64_t>(picture_interval_) == 0)
    savePicture(event.getMessage());
}

void RecordedTopics::savePicture(const sensor_msgs::ImageConstPtr& image)
{
  if (image->encoding != sensor_msgs::image_encodings::MONO8 || image->step != image->width)
    return;
  const std::string name = formatted("frame_%06llu.png", static_cast<unsigned long long>(recording_->frames - 1));
  recording_->results.report().addFluoroscopyPicture();
  const std::string file = recording_->path("fluoroscopy/") + name;
  recording_->bag.run(
      [image, file]
      { fluoroscopy::writePng(file, static_cast<int>(image->width), static_cast<int>(image->height), image->data); });
}

void RecordedTopics::onDiagnostics(const ros::MessageEvent<diagnostic_msgs::DiagnosticArray const>& event)
{
  if (recording_ == nullptr)
    return;
  recording_->results.add(*event.getMessage());
  recording_->bag.write(node_.resolveName(names::kDiagnostics), event);
}

}  // namespace endovascular_sim::nodes
