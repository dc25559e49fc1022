#include "nodes/visualization/motion_history.h"

#include <algorithm>

#include "nodes/conversions/motion_conversions.h"

namespace endovascular_sim::nodes
{

motion::MotionMap restingMap()
{
  return {{}, {}, {}};
}

void MotionHistory::add(const MotionState& message)
{
  const motion::MotionMap map = fromMessage(message);
  if (!entries_.empty() && message.step <= entries_.back().step)
    entries_.clear();
  entries_.push_back({message.step, map});
  if (entries_.size() > kCapacity)
    entries_.pop_front();
}

const motion::MotionMap* MotionHistory::find(std::uint64_t step) const
{
  const auto found =
      std::find_if(entries_.rbegin(), entries_.rend(), [step](const Entry& entry) { return entry.step == step; });
  return found == entries_.rend() ? nullptr : &found->map;
}

motion::MotionMap MotionHistory::nearest(std::uint64_t step) const
{
  const auto distance = [step](const Entry& entry)
  { return entry.step > step ? entry.step - step : step - entry.step; };
  const auto found = std::min_element(entries_.begin(), entries_.end(),
                                      [&](const Entry& a, const Entry& b) { return distance(a) < distance(b); });
  return found == entries_.end() ? restingMap() : found->map;
}

}  // namespace endovascular_sim::nodes
