#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include <ros/ros.h>
#include <topic_tools/shape_shifter.h>

#include "endovascular_sim/PlayerControl.h"
#include "endovascular_sim/PlayerState.h"
#include "nodes/player/bag_timeline.h"
#include "nodes/player/playback.h"
#include "nodes/player/recorded_course.h"
#include "nodes/player/recorded_wall.h"

namespace endovascular_sim::nodes
{

/** Settings of the player, from its private parameters and the arguments of its program. */
struct PlayerSettings
{
  std::vector<std::string> bags;
  double rate = 1.0;   ///< relative to the recording [1]
  double start = 0.0;  ///< simulated time after the first state [s]
  double delay = 0.0;  ///< wall time before it plays, so that a display can start [s]
  bool is_paused = false, is_looping = false;
  PlayedImages images = PlayedImages::kRendered;
};

/** Reads the settings.
 *  @param arguments of the program: bags and options, as of `rosbag play`
 *  @throws InputError for an unknown option and an impossible value */
PlayerSettings playerSettings(const ros::NodeHandle& parameters, const std::vector<std::string>& arguments);

/** ROS node that plays a recorded session: its topics under their names, the wall of each time, /clock, and the state
 * of the player. After a jump the last message of every topic is published, byte for byte as recorded. */
class PlayerNode
{
public:
  /** Opens the recording, and shows its first state.
   *  @throws InputError as BagTimeline */
  PlayerNode(ros::NodeHandle node, const PlayerSettings& settings);
  PlayerNode(const PlayerNode&) = delete;
  PlayerNode& operator=(const PlayerNode&) = delete;

private:
  void advertise();
  bool onControl(PlayerControl::Request& request, PlayerControl::Response& response);
  void onTick();
  void play(const PlayedSpan& span);
  void showState(bool with_poses);
  void showRest(ros::Time time);
  void publish(std::size_t entry);
  void publishStaticFrames(ros::Time time);
  void publishInfo();
  void publishWall(bool always);
  void publishClock();
  void publishState();
  bool isStreamOf(std::size_t stream, const char* name) const;

  ros::NodeHandle node_;
  BagTimeline timeline_;
  RecordedCourse course_;
  RecordedWall wall_;
  Playback playback_;
  PlayerState state_;                                ///< as published last
  std::vector<ros::Publisher> publishers_;           ///< of each topic of the timeline; invalid for contents
  std::vector<topic_tools::ShapeShifter> contents_;  ///< of each topic
  ros::Publisher clock_, player_state_, info_, mesh_;
  std::uint64_t wall_version_ = 0;  ///< that was published last
  bool has_wall_ = false;           ///< a wall was published
  ros::SteadyTime now_, wall_published_, state_published_, begin_;
  ros::SteadyTime show_at_;  ///< when the shown state is repeated
  int repetitions_ = 0;      ///< of the shown state since the last jump
  bool is_waiting_ = false;  ///< true during the delay before it plays
  // Last, so that they end before the members that their callbacks use.
  ros::ServiceServer control_;
  ros::SteadyTimer timer_;
};

}  // namespace endovascular_sim::nodes
