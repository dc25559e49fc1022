#include "nodes/player/player_node.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>

#include <rosgraph_msgs/Clock.h>
#include <tf2_msgs/TFMessage.h>

#include "common/error.h"
#include "endovascular_sim/ContactForceMap.h"
#include "endovascular_sim/ContactForces.h"
#include "endovascular_sim/TreatmentVisual.h"
#include "nodes/runtime/ros_names.h"
#include "nodes/session/session_bag.h"
#include "nodes/session/session_files.h"

namespace endovascular_sim::nodes
{
namespace
{

constexpr double kTick = 0.01;           ///< between two movements of the playhead [s]
constexpr double kWallPeriod = 0.5;      ///< between two meshes of a wall that moves, as of vessel_server [s]
constexpr double kPlayingPeriod = 0.05;  ///< between two states of the player while it plays [s]
constexpr double kPausedPeriod = 0.5;    ///< the same while it does not [s]
constexpr std::uint32_t kQueue = 100;    ///< of a played topic
constexpr double kLongestDelay = 600.0;  ///< [s]

// A display that detects the jump of the clock forgets what it has received until then, which may be the state after
// the jump. So the state is repeated: with the poses, which must not be given twice, and without them.
constexpr double kFirstRepetition = 0.3;  ///< time after a jump [s]
constexpr double kRepetition = 0.7;       ///< between two further repetitions [s]
constexpr int kRepetitions = 2;           ///< after a jump also while it plays; more only while it does not

double numberOf(const std::string& option, const std::string& text)
{
  char* end = nullptr;
  const double value = std::strtod(text.c_str(), &end);
  if (text.empty() || *end != '\0' || !std::isfinite(value))
    throw InputError("player", option, "'" + text + "' is no number; give for example " + option + "=2");
  return value;
}

/** Reads an option of the program, as those of `rosbag play`. */
void readOption(const std::string& argument, PlayerSettings& settings)
{
  const std::size_t equals = argument.find('=');
  const std::string option = argument.substr(0, equals);
  const std::string value = equals == std::string::npos ? "" : argument.substr(equals + 1);
  if (option == "--pause")
    settings.is_paused = true;
  else if (option == "--loop" || option == "-l")
    settings.is_looping = true;
  else if (option == "--rate")
    settings.rate = numberOf(option, value);
  else if (option == "--start")
    settings.start = numberOf(option, value);
  else if (option == "--delay")
    settings.delay = numberOf(option, value);
  else
    throw InputError("player", argument, "is unknown; the options are --pause, --loop, --rate=, --start= and --delay=");
}

void checkSettings(const PlayerSettings& settings)
{
  if (!(settings.rate >= Playback::kSlowest && settings.rate <= Playback::kFastest))
    throw InputError("player", "rate", "must be 0.1 to 10");
  if (!(settings.start >= 0.0) || !std::isfinite(settings.start))
    throw InputError("player", "start", "must be a time of at least 0 s");
  if (!(settings.delay >= 0.0 && settings.delay <= kLongestDelay))
    throw InputError("player", "delay", "must be a time of 0 to 600 s");
}

}  // namespace

PlayerSettings playerSettings(const ros::NodeHandle& parameters, const std::vector<std::string>& arguments)
{
  PlayerSettings settings;
  settings.rate = parameters.param("rate", settings.rate);
  settings.start = parameters.param("start", settings.start);
  settings.delay = parameters.param("delay", settings.delay);
  settings.is_paused = parameters.param("paused", false);
  settings.is_looping = parameters.param("loop", false);
  const std::string images = parameters.param<std::string>("x_ray", "rendered");
  if (images != "rendered" && images != "recorded")
    throw InputError("parameter server", parameters.resolveName("x_ray"), "must be rendered or recorded");
  settings.images = images == "recorded" ? PlayedImages::kRecorded : PlayedImages::kRendered;
  const std::string bag = parameters.param<std::string>("bag", "");
  if (!bag.empty())
    settings.bags.push_back(bag);
  for (const std::string& argument : arguments)
    if (!argument.empty() && argument.front() == '-')
      readOption(argument, settings);
    else if (!argument.empty())
      settings.bags.push_back(argument);
  settings.bags = bagsOfOneSession(settings.bags);
  checkSettings(settings);
  return settings;
}

PlayerNode::PlayerNode(ros::NodeHandle node, const PlayerSettings& settings)
  : node_(std::move(node)),
    timeline_(settings.bags, settings.images),
    course_(timeline_),
    wall_(timeline_),
    playback_(timeline_, course_.chapters()),
    begin_(ros::SteadyTime::now())
{
  using Request = PlayerControl::Request;
  const std::vector<RecordedState>& states = timeline_.states();
  state_.first = states.front().simulated;
  state_.last = states.back().simulated;
  state_.first_step = states.front().step;
  state_.last_step = states.back().step;
  state_.chapters = course_.chapters();
  state_.missing = timeline_.missing();
  state_.missing.insert(state_.missing.end(), course_.missing().begin(), course_.missing().end());
  for (const std::string& text : state_.missing)
    ROS_WARN("missing in the recording: %s", text.c_str());
  playback_.control(Request::RATE, settings.rate);
  playback_.control(Request::LOOP, settings.is_looping ? 1.0 : 0.0);
  if (settings.start > 0.0)
    playback_.control(Request::SEEK_TIME, state_.first + settings.start);
  begin_ += ros::WallDuration(settings.delay);
  is_waiting_ = !settings.is_paused;
  advertise();
  now_ = ros::SteadyTime::now();
  play(playback_.takeJump());
  control_ = node_.advertiseService(names::kPlayerControl, &PlayerNode::onControl, this);
  timer_ = node_.createSteadyTimer(ros::WallDuration(kTick), [this](const ros::SteadyTimerEvent&) { onTick(); });
}

void PlayerNode::advertise()
{
  clock_ = node_.advertise<rosgraph_msgs::Clock>(names::kClock, 1);
  player_state_ = node_.advertise<PlayerState>(names::kPlayerState, 1, true);
  for (const RecordedTopic& topic : timeline_.topics())
  {
    ros::Publisher publisher;
    contents_.emplace_back();
    contents_.back().morph(topic.md5sum, topic.type, topic.definition, topic.is_latched ? "1" : "0");
    if (isTopic(topic.name, names::kVesselMesh))
      mesh_ = node_.advertise<VesselMesh>(topic.name, 1, true);
    else if (isTopic(topic.name, names::kSessionInfo))
      info_ = node_.advertise<SessionInfo>(topic.name, 1, true);
    else if (topic.use != TopicUse::kContent)
    {
      ros::AdvertiseOptions options(topic.name, kQueue, topic.md5sum, topic.type, topic.definition);
      options.latch = topic.is_latched;
      publisher = node_.advertise(options);
    }
    publishers_.push_back(publisher);
  }
  publishInfo();
}

bool PlayerNode::onControl(PlayerControl::Request& request, PlayerControl::Response& response)
{
  now_ = ros::SteadyTime::now();
  response.message = playback_.control(request.command, request.value);
  response.success = response.message.empty();
  if (response.success)
    is_waiting_ = false;
  play(playback_.takeJump());
  publishState();
  const RecordedState& shown = timeline_.states()[playback_.state()];
  response.time = shown.simulated;
  response.step = shown.step;
  return true;
}

void PlayerNode::onTick()
{
  const ros::SteadyTime before = now_;
  now_ = ros::SteadyTime::now();
  if (is_waiting_ && now_ >= begin_)
  {
    is_waiting_ = false;
    playback_.control(PlayerControl::Request::PLAY, 0.0);
  }
  const bool was_playing = playback_.isPlaying();
  play(playback_.advance((now_ - before).toSec()));
  if (now_ >= show_at_)
  {
    if (repetitions_ < kRepetitions || !playback_.isPlaying())
      showState(repetitions_ == 0 && !playback_.isPlaying());
    ++repetitions_;
    show_at_ = now_ + ros::WallDuration(kRepetition);
  }
  publishWall(false);
  publishClock();
  const double period = playback_.isPlaying() ? kPlayingPeriod : kPausedPeriod;
  if (was_playing != playback_.isPlaying() || (now_ - state_published_).toSec() >= period)
    publishState();
}

/** Publishes what a movement of the playhead has passed, or after a jump the state at the playhead. */
void PlayerNode::play(const PlayedSpan& span)
{
  if (span.is_jump)
  {
    publishClock();
    publishState();
    repetitions_ = 0;
    show_at_ = now_ + ros::WallDuration(kFirstRepetition);
    showState(false);
    return;
  }
  publishClock();
  for (std::size_t entry = span.first; entry < span.last; ++entry)
    if (timeline_.topics()[timeline_.streams()[timeline_.entries()[entry].stream].topic].name != "/tf_static")
      publish(entry);
}

bool PlayerNode::isStreamOf(std::size_t stream, const char* name) const
{
  const std::string& topic = timeline_.topics()[timeline_.streams()[stream].topic].name;
  return topic == name || isTopic(topic, name);
}

/** Publishes the last message of every topic at the playhead.
 *  @param with_poses also those of /tf: a pose of the same time is refused by those who have it */
void PlayerNode::showState(bool with_poses)
{
  const ros::Time time = playback_.time();
  publishWall(true);
  for (std::size_t stream = 0; stream < timeline_.streams().size(); ++stream)
  {
    const TopicUse use = timeline_.topics()[timeline_.streams()[stream].topic].use;
    if (use != TopicUse::kState || isStreamOf(stream, "/tf_static") || (!with_poses && isStreamOf(stream, "/tf")))
      continue;
    if (const auto entry = timeline_.newest(stream, time))
      publish(*entry);
  }
  publishStaticFrames(time);
  showRest(time);
}

/** Publishes that topics are empty whose first message comes later: displays may show a later one. */
void PlayerNode::showRest(ros::Time time)
{
  for (std::size_t stream = 0; stream < timeline_.streams().size(); ++stream)
  {
    if (timeline_.newest(stream, time))
      continue;
    const ros::Publisher& publisher = publishers_[timeline_.streams()[stream].topic];
    std_msgs::Header header;
    header.stamp = time;
    header.frame_id = names::kPatientFrame;
    const RecordedState& shown = timeline_.states()[playback_.state()];
    if (isStreamOf(stream, names::kTreatmentVisual))
    {
      TreatmentVisual empty;
      empty.header = header;
      empty.step = shown.step;
      empty.time = shown.simulated;
      publisher.publish(empty);
    }
    else if (isStreamOf(stream, names::kContactForceMap))
    {
      ContactForceMap empty;
      empty.header = header;
      empty.step = shown.step;
      empty.time = shown.simulated;
      empty.content_hash = timeline_.info() ? timeline_.info()->mesh_hash : 0;
      publisher.publish(empty);
    }
    else if (isStreamOf(stream, names::kContactForces))
    {
      ContactForces empty;
      empty.header = header;
      empty.step = shown.step;
      publisher.publish(empty);
    }
  }
}

void PlayerNode::publish(std::size_t entry)
{
  const std::size_t topic = timeline_.streams()[timeline_.entries()[entry].stream].topic;
  const ros::Publisher& publisher = publishers_[topic];
  if (!publisher || (publisher.getNumSubscribers() == 0 && !publisher.isLatched()))
    return;
  const BagMessage& message = timeline_.message(entry);
  ros::serialization::IStream bytes(const_cast<std::uint8_t*>(message.data), message.size);
  contents_[topic].read(bytes);
  publisher.publish(contents_[topic]);
}

/** Publishes all static frames in one message: a latched topic gives late subscribers only its last one. */
void PlayerNode::publishStaticFrames(ros::Time time)
{
  tf2_msgs::TFMessage all;
  const ros::Publisher* publisher = nullptr;
  for (std::size_t stream = 0; stream < timeline_.streams().size(); ++stream)
  {
    const auto entry = isStreamOf(stream, "/tf_static") ? timeline_.newest(stream, time) : std::nullopt;
    if (!entry)
      continue;
    const auto frames = timeline_.message(*entry).read<tf2_msgs::TFMessage>();
    all.transforms.insert(all.transforms.end(), frames->transforms.begin(), frames->transforms.end());
    publisher = &publishers_[timeline_.streams()[stream].topic];
  }
  if (publisher != nullptr)
    publisher->publish(all);
}

void PlayerNode::publishInfo()
{
  if (info_ && timeline_.info())
    info_.publish(*timeline_.info());
}

/** Publishes the wall at the playhead if it has moved, at most at the rate of vessel_server.
 *  @param always without a limit of the rate */
void PlayerNode::publishWall(bool always)
{
  if (!mesh_ || (!always && (now_ - wall_published_).toSec() < kWallPeriod))
    return;
  wall_published_ = now_;
  const std::optional<std::uint64_t> version = wall_.versionAt(playback_.time());
  if (!version || (has_wall_ && *version == wall_version_))
    return;
  try
  {
    const std::optional<VesselMesh> wall = wall_.at(playback_.time());
    mesh_.publish(*wall);
    wall_version_ = *version;
    has_wall_ = true;
  }
  catch (const std::exception& error)
  {
    ROS_WARN_THROTTLE(5.0, "the wall at this time cannot be shown: %s", error.what());
  }
}

void PlayerNode::publishClock()
{
  rosgraph_msgs::Clock clock;
  clock.clock = playback_.time();
  clock_.publish(clock);
}

void PlayerNode::publishState()
{
  state_published_ = now_;
  const RecordedState& shown = timeline_.states()[playback_.state()];
  state_.header.stamp = playback_.time();
  state_.time = shown.simulated;
  state_.step = shown.step;
  state_.rate = playback_.rate();
  state_.playing = playback_.isPlaying() || is_waiting_;
  state_.loop = playback_.isLooping();
  state_.jumps = playback_.jumps();
  state_.peak_hand_force = course_.peakHandForce(playback_.state());
  state_.peak_node_force = course_.peakNodeForce(playback_.state());
  state_.c_arm_view = course_.viewAt(playback_.time());
  player_state_.publish(state_);
}

}  // namespace endovascular_sim::nodes
