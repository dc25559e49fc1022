#include "robot/command_fault.h"

#include <cmath>

#include "common/archive.h"
#include "common/archive_checks.h"
#include "common/numerics/counter_hash.h"
#include "robot/backlash.h"

namespace endovascular_sim::robot
{
namespace
{

constexpr double kSameTime = 1e-9;               ///< tolerance of the time of a step [s]
constexpr double kLongestDelay = 10.0;           ///< [s]
constexpr double kShortestInterval = 1e-6;       ///< [s]
constexpr std::uint64_t kStream = 0x6661756c74;  ///< of the random numbers of faults

}  // namespace

const std::vector<std::string>& faultWords()
{
  static const std::vector<std::string> words = {"stuck", "slipping", "delayed", "backlash"};
  return words;
}

const std::vector<std::string>& axisWords()
{
  static const std::vector<std::string> words = {"insertion", "rotation"};
  return words;
}

void FaultSettings::archive(Archive& archive)
{
  std::uint64_t number = instrument;
  archive(number, axis, kind, amount, start, end, probability, interval, seed);
  instrument = static_cast<std::size_t>(number);
}

std::string refusalOf(const FaultSettings& fault)
{
  if (!std::isfinite(fault.amount) || fault.amount < 0.0)
    return "amount must be 0 or more";
  if (fault.kind == FaultKind::kSlipping && fault.amount > 1.0)
    return "amount is the share of the motion that slips; must be at most 1";
  if (fault.kind == FaultKind::kDelayed && fault.amount > kLongestDelay)
    return "amount is a delay in s; must be at most 10";
  if (!(fault.start >= 0.0) || !std::isfinite(fault.start))
    return "start must be 0 or more";
  if (!(fault.end > fault.start))
    return "end must be after the start";
  if (!(fault.probability >= 0.0 && fault.probability <= 1.0))
    return "probability must be between 0 and 1";
  if (!(fault.interval >= kShortestInterval) || !std::isfinite(fault.interval))
    return "interval must be positive";
  return "";
}

CommandFault::CommandFault(const FaultSettings& settings, double time_step, std::uint64_t seed, double position)
  : settings_(settings), time_step_(time_step), seed_(seed), commanded_(position), executed_(position)
{
}

bool CommandFault::isActive(std::uint64_t step) const
{
  const double time = static_cast<double>(step) * time_step_ + kSameTime;
  if (time < settings_.start || time >= settings_.end)
    return false;
  if (settings_.probability >= 1.0)
    return true;
  const auto interval = static_cast<std::uint64_t>((time - settings_.start) / settings_.interval);
  const std::uint64_t place =
      (settings_.instrument * faultWords().size() + static_cast<std::size_t>(settings_.kind)) * axisWords().size() +
      static_cast<std::size_t>(settings_.axis);
  return uniformNumber(mixedBits(settings_.seed ^ mixedBits(seed_)), kStream + place, interval) < settings_.probability;
}

/** Position of a drive with a delay: it waits until the first command arrives. */
double CommandFault::delayed(double commanded)
{
  waiting_.push_back(commanded);
  const auto delay = static_cast<std::size_t>(std::llround(settings_.amount / time_step_));
  if (waiting_.size() <= delay)
    return executed_;
  const double arrived = waiting_.front();
  waiting_.pop_front();
  return arrived;
}

double CommandFault::execute(std::uint64_t step, double commanded)
{
  const bool acts = isActive(step);
  switch (settings_.kind)
  {
    case FaultKind::kStuck:
      executed_ = acts ? executed_ : commanded;
      break;
    case FaultKind::kSlipping:
      slipped_ += acts ? settings_.amount * (commanded - commanded_) : 0.0;
      executed_ = commanded - slipped_;
      break;
    case FaultKind::kDelayed:
      executed_ = acts ? delayed(commanded) : commanded;
      if (!acts)
        waiting_.clear();
      break;
    case FaultKind::kBacklash:
      executed_ = acts ? drivenAfterPlay(executed_, commanded, settings_.amount) : commanded;
      break;
  }
  commanded_ = commanded;
  return executed_;
}

void CommandFault::restAt(double position)
{
  commanded_ = executed_ = position;
  slipped_ = 0.0;
  waiting_.clear();
}

void CommandFault::archive(Archive& archive)
{
  archive(settings_, time_step_, seed_, commanded_, executed_, slipped_, waiting_);
  if (!archive.reading())
    return;
  requireIndex(static_cast<int>(settings_.kind), 0, static_cast<int>(faultWords().size()));
  requireIndex(static_cast<int>(settings_.axis), 0, static_cast<int>(axisWords().size()));
  requireLoaded(refusalOf(settings_).empty(), "holds an impossible fault");
  requireLoaded(std::isfinite(time_step_) && time_step_ > 0.0, "holds an impossible time step");
  requireFinite(commanded_, executed_, slipped_);
  for (const double command : waiting_)
    requireFinite(command);
}

}  // namespace endovascular_sim::robot
