#pragma once

#include <cstddef>
#include <cstdint>
#include <string>

#include <ros/time.h>

#include "endovascular_sim/PlayerChapter.h"
#include "nodes/player/bag_timeline.h"

namespace endovascular_sim::nodes
{

/** Messages that a movement of the playhead passes. */
struct PlayedSpan
{
  bool is_jump = false;             ///< true: the state at the playhead is shown instead of the messages up to it
  std::size_t first = 0, last = 0;  ///< entries of the timeline, the last one excluded
};

/** Playhead of a recording: which messages are due, at which speed, and where a command leads. It reads no clock.
 *
 *  It follows the time of the recording. Where this passes without a state, because the session was paused or its
 *  recording interrupted, the playhead goes on after kLongestPause. */
class Playback
{
public:
  static constexpr double kSlowest = 0.1, kFastest = 10.0;  ///< rates [1]
  static constexpr double kLongestPause = 1.0;              ///< [s]

  /** @param timeline, chapters outlive this object */
  Playback(const BagTimeline& timeline, const std::vector<PlayerChapter>& chapters);

  /** Carries out a command of PlayerControl.
   *  @return reason of a refusal, which changes nothing; empty without one */
  std::string control(std::uint8_t command, double value);

  /** Moves the playhead while it plays. @param seconds since the last call [s] */
  PlayedSpan advance(double seconds);

  /** Movement that the commands since the last call have caused. */
  PlayedSpan takeJump();

  ros::Time time() const { return time_; }      ///< playhead, time of the recording
  std::size_t state() const { return state_; }  ///< index of the shown state
  double rate() const { return rate_; }         ///< relative to the recording [1]
  bool isPlaying() const { return is_playing_; }
  bool isLooping() const { return is_looping_; }
  std::uint32_t jumps() const { return jumps_; }

  /** Index of the chapter that contains the shown state; that of none is the number of chapters. */
  std::size_t presentChapter() const;

private:
  std::string play();
  std::string step(double states);
  std::string seekTime(double time);
  std::string seekStep(double step);
  std::string seekChapter(double index);
  std::string skipChapters(double number);
  std::size_t placeOf(const PlayerChapter& chapter) const;
  void jumpTo(std::size_t state);
  PlayedSpan moveTo(ros::Time time);
  bool isAtEnd() const { return time_ >= timeline_.states().back().end; }

  const BagTimeline& timeline_;
  const std::vector<PlayerChapter>& chapters_;
  ros::Time time_;
  std::size_t state_ = 0;
  std::size_t next_ = 0;  ///< first entry after the playhead
  double rate_ = 1.0;
  bool is_playing_ = false, is_looping_ = false, has_jumped_ = true;
  std::uint32_t jumps_ = 0;
};

}  // namespace endovascular_sim::nodes
