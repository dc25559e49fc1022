#include "nodes/player/bag_timeline.h"

#include <algorithm>
#include <functional>
#include <utility>

#include <tf2_msgs/TFMessage.h>

#include "common/error.h"
#include "endovascular_sim/BloodFlow.h"
#include "endovascular_sim/CArm.h"
#include "endovascular_sim/ContactForceMap.h"
#include "endovascular_sim/ContactForces.h"
#include "endovascular_sim/ContrastCells.h"
#include "endovascular_sim/ContrastInjection.h"
#include "endovascular_sim/ContrastState.h"
#include "endovascular_sim/DriveApplied.h"
#include "endovascular_sim/FlowNetwork.h"
#include "endovascular_sim/HeartPhase.h"
#include "endovascular_sim/HemodynamicControls.h"
#include "endovascular_sim/MotionControls.h"
#include "endovascular_sim/MotionState.h"
#include "endovascular_sim/ProcedureStep.h"
#include "endovascular_sim/RodStateVisual.h"
#include "endovascular_sim/SensorReading.h"
#include "endovascular_sim/SessionSample.h"
#include "endovascular_sim/TreatmentVisual.h"
#include "endovascular_sim/VesselCentreline.h"
#include "endovascular_sim/VesselMesh.h"
#include "endovascular_sim/WallDisplacement.h"
#include "nodes/runtime/ros_names.h"
#include "nodes/session/bag_survey.h"
#include "nodes/session/session_bag.h"

namespace endovascular_sim::nodes
{
namespace
{

// Topics of recordings only.
constexpr auto kSessionMark = "session/mark";
constexpr auto kSessionGap = "session/gap";
constexpr std::size_t kMostStreams = 60000;  // that an index of 16 bits can name

/** Type of messages of this package in this version. */
struct PresentType
{
  std::string type, md5sum, definition;
  std::function<bool(const BagMessage&)> is_equal;  ///< true if a message has the fields of this version
};

template <typename Message>
PresentType presentType()
{
  return {ros::message_traits::DataType<Message>::value(), ros::message_traits::MD5Sum<Message>::value(),
          ros::message_traits::Definition<Message>::value(), &BagMessage::is<Message>};
}

/** Type of this version with the name of a message's type; null for a type of another package. */
const PresentType* presentTypeOf(const BagMessage& message)
{
  static const std::vector<PresentType> types = {presentType<SessionInfo>(),
                                                 presentType<VesselMesh>(),
                                                 presentType<VesselCentreline>(),
                                                 presentType<RodStateVisual>(),
                                                 presentType<TreatmentVisual>(),
                                                 presentType<ContactForces>(),
                                                 presentType<ContactForceMap>(),
                                                 presentType<ProcedureStep>(),
                                                 presentType<SessionSample>(),
                                                 presentType<WallDisplacement>(),
                                                 presentType<CArm>(),
                                                 presentType<SensorReading>(),
                                                 presentType<FlowNetwork>(),
                                                 presentType<BloodFlow>(),
                                                 presentType<HeartPhase>(),
                                                 presentType<HemodynamicControls>(),
                                                 presentType<ContrastCells>(),
                                                 presentType<ContrastInjection>(),
                                                 presentType<ContrastState>(),
                                                 presentType<MotionState>(),
                                                 presentType<MotionControls>(),
                                                 presentType<DriveApplied>()};
  for (const PresentType& type : types)
    if (type.type == message.type)
      return &type;
  return nullptr;
}

bool isOneOf(const std::string& topic, std::initializer_list<const char*> names)
{
  return std::any_of(names.begin(), names.end(),
                     [&topic](const char* name) { return topic == name || isTopic(topic, name); });
}

/** Reports whether a topic is neither shown nor of use: diagnostics are those of another computer at another time. */
bool isLeftOut(const std::string& topic, PlayedImages images)
{
  if (isOneOf(topic, {names::kDiagnostics, names::kClock, "rosout", names::kSessionEnd, names::kSimulationRun,
                      names::kSessionSteps, names::kPlayerState}))
    return true;
  return images == PlayedImages::kRendered && topic.find("/fluoroscopy/") != std::string::npos &&
         !isTopic(topic, names::kCArmCommand);
}

TopicUse useOf(const std::string& topic)
{
  if (isOneOf(topic, {names::kVesselMesh, names::kWallDisplacement}))
    return TopicUse::kContent;
  return isOneOf(topic, {names::kDriveApplied, kSessionMark, kSessionGap}) ? TopicUse::kEvent : TopicUse::kState;
}

/** Reports whether a topic is latched in every session, although bags of former versions may not say so. */
bool isAlwaysLatched(const std::string& topic)
{
  return isOneOf(topic, {names::kSessionInfo, names::kVesselMesh, names::kVesselCentreline, names::kProcedureStep,
                         names::kContactForceMap, "/tf_static"});
}

/** Frames whose poses a message holds; empty for other topics than /tf and /tf_static. */
std::string framesOf(const BagMessage& message)
{
  std::string frames;
  if (message.topic == "/tf" || message.topic == "/tf_static")
    for (const geometry_msgs::TransformStamped& transform : message.read<tf2_msgs::TFMessage>()->transforms)
      frames += " " + transform.child_frame_id;
  return frames;
}

}  // namespace

/** Index of one bag. */
struct BagTimeline::File
{
  std::string path;
  BagSurvey survey;
  std::vector<RecordedEntry> entries;
  std::vector<RecordedState> states;
  std::uint64_t unreadable = 0;  ///< number of messages that cannot be read
};

BagTimeline::BagTimeline(const std::vector<std::string>& files, PlayedImages images)
{
  if (files.empty())
    throw InputError("player", "bag", "missing; give the session.bag of a results folder");
  std::vector<File> indexed;
  for (const std::string& path : files)
  {
    indexed.push_back({});
    indexed.back().path = path;
    index(indexed.back(), images);
  }
  merge(indexed);
  completeStates();
}

void BagTimeline::index(File& file, PlayedImages images)
{
  readBagMessages(file.path,
                  [&](const BagMessage& message)
                  {
                    try
                    {
                      add(file, message, images);
                    }
                    catch (const ros::Exception&)  // the bytes of the message are damaged
                    {
                      ++file.unreadable;
                    }
                  });
  file.survey = surveyBag(file.path, false);
  if (file.states.empty())
    throw InputError(file.path, names::kRodStateVisual,
                     "holds no state that can be shown" +
                         (file.survey.damage.empty() ? std::string() : "; the bag is damaged: " + file.survey.damage) +
                         "; rosrun endovascular_sim bag_check " + file.path + " names its content");
}

void BagTimeline::add(File& file, const BagMessage& message, PlayedImages images)
{
  const std::optional<std::size_t> stream = streamOf(message, images);
  if (!stream)
    return;
  if (isTopic(message.topic, names::kRodStateVisual))
    addState(file, message);
  RecordedEntry entry;
  entry.time = message.time;
  entry.chunk = message.chunk;
  entry.offset = message.offset;
  entry.size = message.size;
  entry.stream = static_cast<std::uint16_t>(*stream);
  file.entries.push_back(entry);
}

/** Stream of a message; none for a topic that is not played. */
std::optional<std::size_t> BagTimeline::streamOf(const BagMessage& message, PlayedImages images)
{
  const std::string key = message.topic + " " + message.md5sum + framesOf(message);
  const auto [known, is_new] = stream_by_key_.emplace(key, std::nullopt);
  if (!is_new)
    return known->second;
  const std::optional<std::size_t> topic = topicOf(message, images);
  if (!topic || streams_.size() >= kMostStreams)
    return std::nullopt;
  RecordedStream stream;
  stream.topic = *topic;
  known->second = streams_.size();
  streams_.push_back(stream);
  BagMessage prototype = message;
  prototype.data = nullptr;
  prototypes_.push_back(prototype);
  return known->second;
}

/** Topic of a message; none if it is left out, or has the fields of another version. */
std::optional<std::size_t> BagTimeline::topicOf(const BagMessage& message, PlayedImages images)
{
  if (isLeftOut(message.topic, images))
    return std::nullopt;
  RecordedTopic topic = {message.topic, message.type, message.md5sum, message.definition};
  topic.is_latched = message.is_latched || isAlwaysLatched(message.topic);
  topic.use = useOf(message.topic);
  if (const PresentType* present = presentTypeOf(message))
  {
    if (isTopic(message.topic, names::kSessionInfo))
      topic.use = TopicUse::kContent;  // of any version: its fields are read one by one
    else if (!present->is_equal(message))
    {
      miss(message.topic + " has the fields of another version");
      return std::nullopt;
    }
    topic.md5sum = present->md5sum;
    topic.definition = present->definition;
  }
  const auto [known, is_new] = topic_by_name_.emplace(message.topic, topics_.size());
  if (!is_new && known->second)
  {
    if (topics_[*known->second].md5sum == topic.md5sum)
      return known->second;
    miss(message.topic + " has several types; only one is played");
    return std::nullopt;
  }
  topics_.push_back(topic);
  return known->second;
}

void BagTimeline::addState(File& file, const BagMessage& message) const
{
  const auto rod = message.read<RodStateVisual>();
  RecordedState state;
  state.time = state.end = message.time;
  state.simulated = rod->time;
  state.step = rod->step;
  file.states.push_back(state);
}

/** Joins the bags of a session in the order of their steps. */
void BagTimeline::merge(std::vector<File>& files)
{
  std::stable_sort(files.begin(), files.end(),
                   [](const File& a, const File& b) { return a.states.front().step < b.states.front().step; });
  for (std::size_t k = 0; k < files.size(); ++k)
  {
    File& file = files[k];
    if (k > 0)
    {
      const File& before = files[k - 1];
      if (!file.survey.info || !info_ || file.survey.info->scene_hash != info_->scene_hash)
        throw InputError(file.path, names::kSessionInfo,
                         "is not of the session of " + before.path + "; play one of them");
      if (file.states.front().step <= before.states.back().step ||
          file.states.front().time <= before.states.back().time)
        throw InputError(file.path, names::kRodStateVisual,
                         "begins at step " + std::to_string(file.states.front().step) + ", but " + before.path +
                             " holds states up to step " + std::to_string(before.states.back().step) +
                             ": it is another run; play one of them");
      miss("no state between the steps " + std::to_string(before.states.back().step) + " and " +
           std::to_string(file.states.front().step) + ", where the recording was continued");
    }
    else
      info_ = file.survey.info;
    for (RecordedEntry& entry : file.entries)
      entry.file = static_cast<std::uint16_t>(k);
    files_.push_back(file.path);
    chunks_.emplace_back(file.path);
    entries_.insert(entries_.end(), file.entries.begin(), file.entries.end());
    states_.insert(states_.end(), file.states.begin(), file.states.end());
    const std::string name = files.size() > 1 ? file.path + ": " : std::string();
    if (!file.survey.damage.empty())
      miss(name + "damaged: " + file.survey.damage);
    if (file.unreadable > 0)
      miss(name + std::to_string(file.unreadable) + " messages cannot be read");
    for (const StepGap& gap : file.survey.gaps)
      miss(name + "steps " + std::to_string(gap.first) + " to " + std::to_string(gap.last));
    if (!file.survey.recorded_steps && k + 1 == files.size())
      miss(name + "the end of the session");
    if (!file.survey.info)
      miss(name + "the scene (session/info): no X-ray image, no names of instruments");
  }
  std::stable_sort(entries_.begin(), entries_.end(),
                   [](const RecordedEntry& a, const RecordedEntry& b) { return a.time < b.time; });
  for (std::size_t k = 0; k < entries_.size(); ++k)
    streams_[entries_[k].stream].entries.push_back(static_cast<std::uint32_t>(k));
}

/** Sorts the states, and finds the messages that belong to each. */
void BagTimeline::completeStates()
{
  std::stable_sort(states_.begin(), states_.end(),
                   [](const RecordedState& a, const RecordedState& b) { return a.time < b.time; });
  std::vector<RecordedState> ascending;
  std::size_t disordered = 0;
  for (const RecordedState& state : states_)
    // Of states that were recorded at one time, messages of other topics belong to the last one.
    if (!ascending.empty() && state.time == ascending.back().time && state.step >= ascending.back().step)
      ascending.back() = state;
    else if (ascending.empty() ||
             (state.step >= ascending.back().step && state.simulated >= ascending.back().simulated))
      ascending.push_back(state);
    else
      ++disordered;
  if (disordered > 0)
    miss(std::to_string(disordered) + " states stand in the wrong order");
  states_ = std::move(ascending);
  for (const std::uint32_t entry : entriesOf({names::kTreatmentVisual}))
  {
    const ros::Time time = entries_[entry].time;
    RecordedState& state = states_[stateAt(time)];
    if (time <= state.time)
      continue;
    try
    {
      if (message(entry).read<TreatmentVisual>()->step == state.step)
        state.end = time;
    }
    catch (const ros::Exception&)
    {
      continue;  // the bytes of the message are damaged
    }
  }
}

void BagTimeline::miss(const std::string& text)
{
  if (std::find(missing_.begin(), missing_.end(), text) == missing_.end())
    missing_.push_back(text);
}

const RecordedTopic* BagTimeline::topic(const std::string& name) const
{
  for (const RecordedTopic& topic : topics_)
    if (isTopic(topic.name, name))
      return &topic;
  return nullptr;
}

std::vector<std::uint32_t> BagTimeline::entriesOf(const std::vector<std::string>& names) const
{
  std::vector<std::uint32_t> found;
  for (const RecordedStream& stream : streams_)
    if (std::any_of(names.begin(), names.end(),
                    [&](const std::string& name) { return isTopic(topics_[stream.topic].name, name); }))
      found.insert(found.end(), stream.entries.begin(), stream.entries.end());
  std::sort(found.begin(), found.end());
  return found;
}

const BagMessage& BagTimeline::message(std::size_t entry) const
{
  const RecordedEntry& place = entries_.at(entry);
  BagMessage& message = prototypes_[place.stream];
  message.time = place.time;
  message.chunk = place.chunk;
  message.offset = place.offset;
  message.size = place.size;
  message.data = chunks_[place.file].data(place.chunk, place.offset, place.size);
  return message;
}

std::optional<std::size_t> BagTimeline::newest(std::size_t stream, ros::Time time) const
{
  const std::vector<std::uint32_t>& entries = streams_.at(stream).entries;
  const auto later = std::upper_bound(entries.begin(), entries.end(), time,
                                      [this](ros::Time at, std::uint32_t entry) { return at < entries_[entry].time; });
  if (later == entries.begin())
    return std::nullopt;
  return *(later - 1);
}

std::size_t BagTimeline::stateAtTime(double time) const
{
  constexpr double kRounding = 1e-9;  // [s]
  const auto later = std::upper_bound(states_.begin(), states_.end(), time + kRounding,
                                      [](double at, const RecordedState& state) { return at < state.simulated; });
  return later == states_.begin() ? 0 : static_cast<std::size_t>(later - states_.begin()) - 1;
}

std::size_t BagTimeline::stateAtStep(std::uint64_t step) const
{
  const auto later = std::upper_bound(states_.begin(), states_.end(), step,
                                      [](std::uint64_t at, const RecordedState& state) { return at < state.step; });
  return later == states_.begin() ? 0 : static_cast<std::size_t>(later - states_.begin()) - 1;
}

std::size_t BagTimeline::stateAt(ros::Time time) const
{
  const auto later = std::upper_bound(states_.begin(), states_.end(), time,
                                      [](ros::Time at, const RecordedState& state) { return at < state.time; });
  return later == states_.begin() ? 0 : static_cast<std::size_t>(later - states_.begin()) - 1;
}

}  // namespace endovascular_sim::nodes
