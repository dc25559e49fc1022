#include "fluoroscopy/motion/phase_grid.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace endovascular_sim::fluoroscopy
{
namespace
{

constexpr std::size_t kPhases = 2048;  // of a beat, between which the heart moves by less than 0.1 mm
constexpr double kCurvature = 1.05;    // of the path of a point during a breath, relative to its chord

/** Displacements of a motion: of the diaphragm, of the middle of the heart, of both ends of its axis, at the border of
 *  the core and within the fade. */
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
  points.emplace_back(0.0, 0.0, -motion.diaphragm());
  return points;
}

double squareDistance(const std::vector<Eigen::Vector3d>& a, const std::vector<Eigen::Vector3d>& b)
{
  double largest = 0.0;
  for (std::size_t k = 0; k < a.size(); ++k)
    largest = std::max(largest, (a[k] - b[k]).squaredNorm());
  return largest;
}

/** Motions of a beat or a breath. */
struct Course
{
  std::vector<motion::MotionShares> shares;
  std::vector<std::vector<Eigen::Vector3d>> places;
};

BodyMotion bodyMotion(const motion::PatientMotion& motion, const motion::MotionShares& shares)
{
  return {motion.map({shares, {}}), shares.breath * motion.settings().breathing.diaphragm};
}

Course courseOf(const motion::PatientMotion& motion, std::vector<motion::MotionShares> shares)
{
  Course course;
  course.shares = std::move(shares);
  for (const motion::MotionShares& each : course.shares)
    course.places.push_back(displacementsOf(bodyMotion(motion, each)));
  return course;
}

/** Shares of the heart over a beat. They do not depend on the rate but for the duration of systole. */
std::vector<motion::MotionShares> beat(const motion::PatientMotion& motion)
{
  std::vector<motion::MotionShares> shares;
  for (std::size_t k = 0; k < kPhases; ++k)
    shares.push_back(motion.at(static_cast<double>(k) / kPhases, motion.settings().heart.rate, 0.0, 0.0).shares);
  return shares;
}

/** Shares of a course, the first one among them, of which one is within a tolerance of each. */
std::vector<motion::MotionShares> representatives(const Course& course, double tolerance)
{
  const double square = tolerance * tolerance;
  const std::size_t size = course.shares.size();
  const auto isNear = [&](std::size_t a, std::size_t b)
  { return squareDistance(course.places[a], course.places[b]) <= square; };
  const auto representsAll = [&](std::size_t first, std::size_t last)
  {
    std::size_t k = first;
    while (k < last && isNear(k, last))
      ++k;
    return k == last;
  };
  std::vector<motion::MotionShares> result;
  std::size_t open = 0, centre = 0;  // the first one without a representative, its representative
  while (open < size)
  {
    result.push_back(course.shares[centre]);
    for (open = std::max(open, centre); open < size && isNear(open, centre);)
      ++open;
    for (centre = open; centre + 1 < size && representsAll(open, centre + 1);)
      ++centre;
  }
  return result;
}

}  // namespace

PhaseGrid::PhaseGrid(const motion::PatientMotion& motion, double tolerance)
{
  const std::vector<Eigen::Vector3d> rest = displacementsOf(bodyMotion(motion, {}));
  motion::MotionShares inspiration;
  inspiration.breath = 1.0;
  std::vector<Eigen::Vector3d> breath = displacementsOf(bodyMotion(motion, inspiration));
  // With n parts of a breath, the nearest one is at most half a part away. The heart has the rest of the tolerance.
  const auto parts = static_cast<int>(std::ceil(0.5 * std::sqrt(squareDistance(breath, rest)) / tolerance));
  breath.back() = rest.back();  // the diaphragm does not follow the heart
  const double of_breath = parts > 0 ? 0.5 * std::sqrt(squareDistance(breath, rest)) / parts : 0.0;
  const double of_heart = std::max(tolerance - kCurvature * of_breath, 0.3 * tolerance);
  for (motion::MotionShares shares : representatives(courseOf(motion, beat(motion)), of_heart))
    for (int k = 0; k <= parts; ++k)
    {
      shares.breath = parts > 0 ? static_cast<double>(k) / parts : 0.0;
      motions_.push_back(bodyMotion(motion, shares));
      places_.push_back(displacementsOf(motions_.back()));
    }
}

BodyMotion PhaseGrid::nearest(const BodyMotion& motion) const
{
  if (!sameRegion(motion.map().frame(), motions_.front().map().frame()))
    return motion;
  const std::vector<Eigen::Vector3d> places = displacementsOf(motion);
  double least = std::numeric_limits<double>::infinity();
  std::size_t nearest = 0;
  for (std::size_t k = 0; k < places_.size(); ++k)
  {
    const double distance = squareDistance(places_[k], places);
    if (distance < least)
    {
      least = distance;
      nearest = k;
    }
  }
  return motions_[nearest];
}

double distanceBetween(const BodyMotion& a, const BodyMotion& b)
{
  return std::sqrt(squareDistance(displacementsOf(a), displacementsOf(b)));
}

}  // namespace endovascular_sim::fluoroscopy
