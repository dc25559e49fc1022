#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>

#include "endovascular_sim/MotionState.h"
#include "motion/map/motion_map.h"

namespace endovascular_sim::nodes
{

/** Maps of the patient's motion at the last steps, so that a picture shows instruments and vessel of one step. Without
 *  a map the patient is at rest. */
class MotionHistory
{
public:
  static constexpr std::size_t kCapacity = 32;

  /** Map of a step. */
  struct Entry
  {
    std::uint64_t step;
    motion::MotionMap map;
  };

  /** Adds a map. A step that is not later than the last one begins again, as after a reset or a jump.
   *  @throws InputError as fromMessage() */
  void add(const MotionState& message);
  void clear() { entries_.clear(); }

  bool empty() const { return entries_.empty(); }
  /** Newest map. @pre not empty */
  const Entry& newest() const { return entries_.back(); }
  /** Map of a step; null if it is not known. */
  const motion::MotionMap* find(std::uint64_t step) const;
  /** Map of the nearest step; the identity without any. */
  motion::MotionMap nearest(std::uint64_t step) const;

private:
  std::deque<Entry> entries_;  ///< in the order of their steps
};

/** Map of a patient at rest. */
motion::MotionMap restingMap();

}  // namespace endovascular_sim::nodes
