#pragma once

#include <cstddef>
#include <deque>
#include <utility>
#include <vector>

#include "fluoroscopy/motion/body_motion.h"

namespace endovascular_sim::fluoroscopy
{

/** Changes of a projection at the motions that occurred so far in one pose. When the memory is full, the oldest change
 * is forgotten. */
class ChangeCache
{
public:
  /** @param memory of all changes [bytes] */
  explicit ChangeCache(std::size_t memory) : memory_(memory) {}

  /** Change of an equal motion; null without one. Valid until the next call of put(). */
  const std::vector<float>* find(const BodyMotion& motion) const;

  void put(const BodyMotion& motion, std::vector<float> change);

  /** Forgets all changes: another pose, another patient. */
  void clear() { entries_.clear(); }

  std::size_t size() const { return entries_.size(); }  ///< number of changes

private:
  std::size_t memory_;
  std::deque<std::pair<BodyMotion, std::vector<float>>> entries_;
};

}  // namespace endovascular_sim::fluoroscopy
