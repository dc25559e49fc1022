#include "nodes/player/playback.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "common/text/format.h"
#include "endovascular_sim/PlayerControl.h"

namespace endovascular_sim::nodes
{
namespace
{

constexpr double kLead = 0.1;         ///< time before the next state at which a skipped pause ends [s]
constexpr double kLongestTick = 0.5;  ///< movement of the playhead in one call, as time of a late caller [s]
constexpr double kSamePlace =
    0.5;  ///< time after the beginning of a chapter in which "back" leads to the one before [s]

bool isWhole(double value)
{
  return std::floor(value) == value;
}

}  // namespace

Playback::Playback(const BagTimeline& timeline, const std::vector<PlayerChapter>& chapters)
  : timeline_(timeline), chapters_(chapters)
{
  jumpTo(0);
}

std::string Playback::control(std::uint8_t command, double value)
{
  using Request = PlayerControl::Request;
  if (!std::isfinite(value))
    return "the value is not finite; give a number";
  switch (command)
  {
    case Request::PLAY:
      return play();
    case Request::PAUSE:
      is_playing_ = false;
      return {};
    case Request::STEP:
      return step(value);
    case Request::SEEK_TIME:
      return seekTime(value);
    case Request::SEEK_STEP:
      return seekStep(value);
    case Request::SEEK_CHAPTER:
      return seekChapter(value);
    case Request::SKIP_CHAPTERS:
      return skipChapters(value);
    case Request::RATE:
      if (value < kSlowest || value > kFastest)
        return formatted("a rate of %g is not possible; give 0.1 to 10", value);
      rate_ = value;
      return {};
    case Request::LOOP:
      is_looping_ = value != 0.0;
      return {};
    default:
      return "command " + std::to_string(command) + " is unknown; give one of PlayerControl.srv";
  }
}

std::string Playback::play()
{
  if (state_ + 1 == timeline_.states().size())
    jumpTo(0);
  is_playing_ = true;
  return {};
}

std::string Playback::step(double states)
{
  if (!isWhole(states))
    return "a number of states is whole; give for example 1 or -1";
  is_playing_ = false;
  const auto last = static_cast<double>(timeline_.states().size() - 1);
  jumpTo(static_cast<std::size_t>(std::clamp(static_cast<double>(state_) + states, 0.0, last)));
  return {};
}

std::string Playback::seekTime(double time)
{
  jumpTo(timeline_.stateAtTime(time));
  return {};
}

std::string Playback::seekStep(double step)
{
  if (step < 0.0 || !isWhole(step) || step > 0x1p53)
    return formatted("%g is no step; give a whole number from 0", step);
  jumpTo(timeline_.stateAtStep(static_cast<std::uint64_t>(step)));
  return {};
}

std::string Playback::seekChapter(double index)
{
  if (index < 0.0 || !isWhole(index) || index >= static_cast<double>(chapters_.size()))
    return formatted("%g is no chapter; the recording has %zu, counted from 0", index, chapters_.size());
  jumpTo(placeOf(chapters_[static_cast<std::size_t>(index)]));
  return {};
}

/** First state of a chapter: the panel shows what has happened at its beginning. */
std::size_t Playback::placeOf(const PlayerChapter& chapter) const
{
  constexpr double kRounding = 1e-9;  // [s]
  const std::size_t state = timeline_.stateAtTime(chapter.time);
  const bool is_before = timeline_.states()[state].simulated < chapter.time - kRounding;
  return is_before && state + 1 < timeline_.states().size() ? state + 1 : state;
}

/** Moves by chapters. The first step back from within a chapter leads to its beginning. Chapters at the same state
 * count as one. */
std::string Playback::skipChapters(double number)
{
  if (!isWhole(number) || number == 0.0)
    return "a number of chapters is whole and not 0; give for example 1 or -1";
  std::vector<std::size_t> places;
  for (const PlayerChapter& chapter : chapters_)
    places.push_back(placeOf(chapter));
  places.erase(std::unique(places.begin(), places.end()), places.end());
  const auto begin = places.begin();
  std::ptrdiff_t target = 0;
  if (number > 0.0)
    target =
        std::upper_bound(begin, places.end(), state_) - begin + static_cast<std::ptrdiff_t>(std::min(number, 1e6)) - 1;
  else
  {
    const double near = timeline_.states()[state_].simulated - (is_playing_ ? kSamePlace : 0.0);
    const std::size_t from = std::min(state_, timeline_.stateAtTime(near));
    target = std::lower_bound(begin, places.end(), from) - begin + static_cast<std::ptrdiff_t>(std::max(number, -1e6));
  }
  if (target < 0)
    jumpTo(0);
  else if (target >= static_cast<std::ptrdiff_t>(places.size()))
    return "this is the last chapter";
  else
    jumpTo(places[static_cast<std::size_t>(target)]);
  return {};
}

void Playback::jumpTo(std::size_t state)
{
  const auto later = [](ros::Time at, const RecordedEntry& entry) { return at < entry.time; };
  state_ = state;
  time_ = timeline_.states()[state].end;
  const std::vector<RecordedEntry>& entries = timeline_.entries();
  next_ = static_cast<std::size_t>(std::upper_bound(entries.begin(), entries.end(), time_, later) - entries.begin());
  has_jumped_ = true;
  ++jumps_;
}

PlayedSpan Playback::takeJump()
{
  PlayedSpan span;
  span.is_jump = has_jumped_;
  span.first = span.last = next_;
  has_jumped_ = false;
  return span;
}

PlayedSpan Playback::advance(double seconds)
{
  if (has_jumped_ || !is_playing_)
    return takeJump();
  if (isAtEnd())
  {
    if (is_looping_)
      jumpTo(0);
    else
      is_playing_ = false;
    return takeJump();
  }
  const std::vector<RecordedState>& states = timeline_.states();
  ros::Time target = time_ + ros::Duration(rate_ * std::clamp(seconds, 0.0, kLongestTick));
  if (state_ + 1 < states.size())
  {
    const ros::Time next = states[state_ + 1].time;
    const bool is_pause = (next - states[state_].time).toSec() > kLongestPause;
    if (is_pause && (target - states[state_].time).toSec() > kLongestPause)
      target = std::max(target, next - ros::Duration(kLead));
  }
  return moveTo(std::min(target, states.back().end));
}

PlayedSpan Playback::moveTo(ros::Time time)
{
  PlayedSpan span;
  span.first = next_;
  const std::vector<RecordedEntry>& entries = timeline_.entries();
  while (next_ < entries.size() && entries[next_].time <= time)
    ++next_;
  span.last = next_;
  time_ = time;
  state_ = timeline_.stateAt(time);
  return span;
}

std::size_t Playback::presentChapter() const
{
  const double time = timeline_.states()[state_].simulated;
  std::size_t present = chapters_.size();
  for (std::size_t k = 0; k < chapters_.size() && chapters_[k].time <= time; ++k)
    present = k;
  return present;
}

}  // namespace endovascular_sim::nodes
