#include "fluoroscopy/patient/change_cache.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace endovascular_sim::fluoroscopy
{
namespace
{

/** Displacements in the middle of the heart, at both ends of its axis, at the border of the core and within the fade.
 */
std::vector<Eigen::Vector3d> displacementsOf(const BodyMotion& motion)
{
  const motion::MotionMap& map = motion.map();
  const motion::HeartFrame& frame = map.frame();
  std::vector<Eigen::Vector3d> points = {frame.fade.centre, frame.base, frame.apex()};
  for (const double radius : {0.95 * frame.fade.core, frame.fade.core + 0.25 * frame.fade.width()})
    for (int axis = 0; axis < 3; ++axis)
      for (const double side : {-radius, radius})
        points.emplace_back(frame.fade.centre + side * Eigen::Vector3d::Unit(axis));
  for (Eigen::Vector3d& point : points)
    point = map.displacement(point);
  return points;
}

double squareDistanceOf(const std::vector<Eigen::Vector3d>& a, const std::vector<Eigen::Vector3d>& b)
{
  double largest = 0.0;
  for (std::size_t k = 0; k < a.size(); ++k)
    largest = std::max(largest, (a[k] - b[k]).squaredNorm());
  return largest;
}

}  // namespace

ChangeCache::Key ChangeCache::keyOf(const BodyMotion& motion)
{
  return {motion.diaphragm(), displacementsOf(motion)};
}

double ChangeCache::squareDistance(const Key& a, const Key& b)
{
  const double diaphragm = a.diaphragm - b.diaphragm;
  return std::max(diaphragm * diaphragm, squareDistanceOf(a.displacements, b.displacements));
}

const std::vector<float>* ChangeCache::find(const BodyMotion& motion) const
{
  if (entries_.empty())
    return nullptr;
  const Key key = keyOf(motion);
  double least = tolerance_ * tolerance_;
  const std::vector<float>* nearest = nullptr;
  for (const Entry& entry : entries_)
  {
    const double distance = squareDistance(entry.key, key);
    if (distance > least)
      continue;
    least = distance;
    nearest = &entry.change;
  }
  return nearest;
}

void ChangeCache::put(const BodyMotion& motion, std::vector<float> change)
{
  const std::size_t size = change.size() * sizeof(float);
  if (size > memory_)
    return;
  while ((entries_.size() + 1) * size > memory_)
    entries_.pop_front();
  entries_.push_back({keyOf(motion), std::move(change)});
}

double distanceBetween(const BodyMotion& a, const BodyMotion& b)
{
  return std::max(std::abs(a.diaphragm() - b.diaphragm()),
                  std::sqrt(squareDistanceOf(displacementsOf(a), displacementsOf(b))));
}

}  // namespace endovascular_sim::fluoroscopy
