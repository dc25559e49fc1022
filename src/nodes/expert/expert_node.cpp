#include "nodes/expert/expert_node.h"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "common/error.h"
#include "endovascular_sim/MotionState.h"
#include "endovascular_sim/PlayerState.h"
#include "endovascular_sim/SessionInfo.h"
#include "endovascular_sim/SimulationRun.h"
#include "endovascular_sim/TreatmentVisual.h"
#include "nodes/conversions/message_checks.h"
#include "nodes/expert/carried_state.h"
#include "nodes/runtime/guarded_subscription.h"
#include "nodes/runtime/ros_names.h"

namespace endovascular_sim::nodes
{
namespace
{

constexpr double kSearchPeriod = 1.0;      ///< between two searches of the recording [s]
constexpr double kAlonePeriod = 1.0 / 30;  ///< between two states of an expert that moves alone [s]
constexpr double kBackwards = 1e-9;        ///< fall of the time that begins another run [s]
constexpr const char* kNames[] = {"hidden", "start", "phase", "insertion", "alone"};

ExpertAlignment alignmentOf(const std::string& name)
{
  for (std::uint8_t k = 0; k < static_cast<std::uint8_t>(ExpertAlignment::kAlone); ++k)
    if (name == kNames[k])
      return static_cast<ExpertAlignment>(k);
  throw InputError("expert", "alignment", "'" + name + "' is unknown; give hidden, start, phase or insertion");
}

}  // namespace

ExpertNode::ExpertNode(ros::NodeHandle node, const ros::NodeHandle& parameters)
  : node_(std::move(node)),
    alignment_(alignmentOf(parameters.param<std::string>("alignment", "hidden"))),
    before_alone_(alignment_),
    visual_(node_.advertise<RodStateVisual>(names::kExpertVisual, 1, true)),
    treatment_(node_.advertise<TreatmentVisual>(names::kExpertTreatment, 1, true)),
    scene_(node_.advertise<SessionInfo>(names::kExpertScene, 1, true)),
    state_(node_.advertise<ExpertState>(names::kExpertState, 1, true))
{
  states_ = subscribeGuarded<RodStateVisual>(node_, names::kRodStateVisual, 1,
                                             [this](const RodStateVisual& state) { receiveState(state); });
  motion_states_ = subscribeGuarded<MotionState>(node_, names::kMotionState, MotionHistory::kCapacity,
                                                 [this](const MotionState& motion) { motions_.add(motion); });
  steps_ = subscribeGuarded<ProcedureStep>(node_, names::kProcedureStep, 4,
                                           [this](const ProcedureStep& step) { receiveStep(step); });
  runs_ = subscribeGuarded<SimulationRun>(node_, names::kSimulationRun, 4,
                                          [this](const SimulationRun& run)
                                          {
                                            if (!run.continued)
                                              first_step_ = run.first_step;
                                          });
  infos_ = subscribeGuarded<SessionInfo>(node_, names::kSessionInfo, 1,
                                         [this](const SessionInfo& info) { time_step_ = info.time_step; });
  players_ = subscribeGuarded<PlayerState>(node_, names::kPlayerState, 1,
                                           [this](const PlayerState& player) { recorded_begin_ = player.first; });
  align_ = node_.advertiseService(names::kAlignExpert, &ExpertNode::onAlign, this);
  show_ = node_.advertiseService(names::kShowExpert, &ExpertNode::onShow, this);
  search_ = node_.createSteadyTimer(ros::WallDuration(kSearchPeriod),
                                    [this](const ros::SteadyTimerEvent&) { searchRecording(); });
  alone_ = node_.createSteadyTimer(
      ros::WallDuration(kAlonePeriod), [this](const ros::SteadyTimerEvent&) { playAlone(); }, false, false);
  searchRecording();
}

/** Loads the recording when its parameter is set, or changes. */
void ExpertNode::searchRecording()
{
  std::string folder;
  if (!node_.getParam(names::kExpertResults, folder) || folder.empty() || folder == folder_)
    return;
  folder_ = folder;
  try
  {
    recording_ = std::make_unique<ExpertRecording>(folder);
  }
  catch (const InputError& error)
  {
    ROS_ERROR("no expert: %s", error.what());
    return;
  }
  if (recording_->info())
    scene_.publish(*recording_->info());
  ROS_INFO("the expert is %s, %zu recorded states", nameOfExpert().c_str(), recording_->course().moments().size());
  align(alignment_);
}

std::string ExpertNode::nameOfExpert() const
{
  if (!recording_ || !recording_->info())
    return "";
  const SessionInfo& info = *recording_->info();
  return info.scene_name + ", " + (info.subject.empty() ? "recorded session" : info.subject);
}

void ExpertNode::receiveStep(const ProcedureStep& step)
{
  step_ = step;
  has_step_ = true;
  follow();
}

void ExpertNode::receiveState(const RodStateVisual& state)
{
  requireUsable(state, state.insertion.size());
  if (has_trainee_ && state.time < trainee_.time - kBackwards)
    has_step_ = has_step_ && step_.begin <= state.time;
  trainee_ = state;
  has_trainee_ = true;
  follow();
}

/** Shows the moment of the expert that belongs to the trainee's newest state and step. */
void ExpertNode::follow()
{
  if (!recording_ || !has_trainee_ || alignment_ == ExpertAlignment::kHidden || alignment_ == ExpertAlignment::kAlone)
    return;
  const RunMoment moment{trainee_.time, trainee_.insertion, has_step_ ? std::max(step_.step_of_procedure, 1U) : 0U};
  show(recording_->course().momentOf(alignment_, moment, beginning(), has_step_ ? step_.begin : beginning()));
}

/** Simulated time of the first state of the trainee's run [s]. */
double ExpertNode::beginning() const
{
  return recorded_begin_.value_or(static_cast<double>(first_step_ + 1) * time_step_);
}

/** Publishes the recorded state of a moment, and the distance of the tips. */
void ExpertNode::show(std::size_t moment)
{
  RodStateVisual state = recording_->state(moment);
  carry(recording_->motion(moment), has_trainee_ ? motions_.nearest(trainee_.step) : restingMap(), state);
  const bool is_alone = alignment_ == ExpertAlignment::kAlone;
  publishState(state.time, is_alone || !has_trainee_ ? std::nan("") : tipDistance(state, trainee_));
  if (has_trainee_)
    state.step = trainee_.step;  // displays pair it with the motion of that step
  // Also where the moment is the same: displays forget what they have shown when the clock jumps back.
  state.header.stamp = ros::Time::now();
  visual_.publish(state);
  TreatmentVisual treatment = recording_->treatment(moment).value_or(TreatmentVisual());
  treatment.header = state.header;
  treatment.step = state.step;
  treatment_.publish(treatment);
}

void ExpertNode::publishState(double expert_time, double distance)
{
  ExpertState message;
  message.header.stamp = ros::Time::now();
  message.alignment = static_cast<std::uint8_t>(alignment_);
  message.time = has_trainee_ ? trainee_.time : 0.0;
  message.expert_time = expert_time;
  message.distance = distance;
  message.name = nameOfExpert();
  state_.publish(message);
}

/** Empty messages remove what is drawn. */
void ExpertNode::hide()
{
  RodStateVisual nothing;
  nothing.header.stamp = ros::Time::now();
  nothing.header.frame_id = names::kPatientFrame;
  // Displays take another number of instruments for another scene.
  const std::size_t instruments = recording_->course().moments().front().insertion.size();
  for (std::vector<double>* values : {&nothing.insertion, &nothing.rotation, &nothing.tip_rotation, &nothing.hand_force,
                                      &nothing.hand_torque, &nothing.pressure})
    values->assign(instruments, 0.0);
  visual_.publish(nothing);
  TreatmentVisual untreated;
  untreated.header = nothing.header;
  treatment_.publish(untreated);
  publishState(std::nan(""), std::nan(""));
}

void ExpertNode::align(ExpertAlignment alignment)
{
  if (alignment == ExpertAlignment::kAlone && alignment_ != ExpertAlignment::kAlone)
    before_alone_ = alignment_;
  alignment_ = alignment;
  alone_.stop();
  if (!recording_)
    return;
  if (alignment == ExpertAlignment::kAlone)
  {
    alone_since_ = ros::SteadyTime::now();
    alone_.start();
    playAlone();
  }
  else if (alignment == ExpertAlignment::kHidden)
    hide();
  else
    follow();
}

/** Shows the expert's state at the time since the alignment kAlone began. After its last state the former alignment
 * returns. */
void ExpertNode::playAlone()
{
  const ExpertCourse& course = recording_->course();
  const double elapsed = (ros::SteadyTime::now() - alone_since_).toSec();
  show(course.momentAfter(elapsed));
  if (course.moments().front().time + elapsed > course.moments().back().time)
    align(before_alone_);
}

bool ExpertNode::onAlign(AlignExpert::Request& request, AlignExpert::Response& response)
{
  response.success = request.alignment <= ExpertState::ALONE && recording_ != nullptr;
  if (request.alignment > ExpertState::ALONE)
    response.message = "the alignment must be 0 to " + std::to_string(ExpertState::ALONE);
  else if (!recording_)
    response.message = "the expert is not recorded yet; expert_recording makes a recording";
  if (response.success)
  {
    align(static_cast<ExpertAlignment>(request.alignment));
    response.message = std::string(kNames[request.alignment]) + ": " + nameOfExpert();
  }
  return true;
}

bool ExpertNode::onShow(std_srvs::Trigger::Request& /*request*/, std_srvs::Trigger::Response& response)
{
  AlignExpert::Request request;
  request.alignment = ExpertState::ALONE;
  AlignExpert::Response answer;
  onAlign(request, answer);
  response.success = answer.success;
  response.message = answer.success ? "the expert moves" : answer.message;
  return true;
}

}  // namespace endovascular_sim::nodes
