#pragma once

#include <cstddef>
#include <deque>
#include <vector>

#include <Eigen/Core>

#include "fluoroscopy/motion/body_motion.h"

namespace endovascular_sim::fluoroscopy
{

/** Changes of a projection at the phases that occurred so far in one pose, for phases that differ by little.
 *
 *  Two motions differ by the largest distance between the places of a point of the patient: of the diaphragm, and of
 *  15 points in and around the heart. A change is taken again for a motion that differs by at most the tolerance.
 *  When the memory is full, the oldest change is forgotten. */
class ChangeCache
{
public:
  /** @param tolerance [m]
   *  @param memory of all changes [bytes] */
  ChangeCache(double tolerance, std::size_t memory) : tolerance_(tolerance), memory_(memory) {}

  /** Change of the nearest motion within the tolerance; null without one. Valid until the next call of put(). */
  const std::vector<float>* find(const BodyMotion& motion) const;

  void put(const BodyMotion& motion, std::vector<float> change);

  /** Forgets all changes: another pose, another patient. */
  void clear() { entries_.clear(); }

  std::size_t size() const { return entries_.size(); }  ///< number of changes

private:
  /** Displacements by which motions are compared. */
  struct Key
  {
    double diaphragm = 0.0;
    std::vector<Eigen::Vector3d> displacements;
  };
  struct Entry
  {
    Key key;
    std::vector<float> change;
  };

  static Key keyOf(const BodyMotion& motion);
  static double squareDistance(const Key& a, const Key& b);

  double tolerance_;
  std::size_t memory_;
  std::deque<Entry> entries_;
};

/** Largest distance between the places of a point of the patient in two motions, by the points of ChangeCache [m]. */
double distanceBetween(const BodyMotion& a, const BodyMotion& b);

}  // namespace endovascular_sim::fluoroscopy
