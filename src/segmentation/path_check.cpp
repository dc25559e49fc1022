#include "segmentation/path_check.h"

#include <algorithm>
#include <cmath>

#include "common/error.h"
#include "common/text/format.h"

namespace endovascular_sim::segmentation
{
namespace
{

constexpr double kShortest = 1.0;       ///< length of a path, in diameters of the lumen
constexpr double kShortestAlone = 1.6;  ///< likewise, of a vessel of one branch: below, its cut ends meet
constexpr double kBeside = 4.0;       ///< distance along the path at which both sides of a click are compared, in radii
constexpr double kLeastBeside = 2.0;  ///< least one, where the path is short, in radii

double lengthOf(const std::vector<Eigen::Vector3d>& points)
{
  double length = 0.0;
  for (std::size_t k = 0; k + 1 < points.size(); ++k)
    length += (points[k + 1] - points[k]).norm();
  return length;
}

/** Point of the path at a distance along it, in the direction of @p step.
 *  @param distance receives the length that remains beyond an end of the path */
Eigen::Vector3d pointBeside(const ClickPath& path, std::size_t from, int step, double& distance)
{
  auto k = static_cast<std::ptrdiff_t>(from);
  const auto count = static_cast<std::ptrdiff_t>(path.points.size());
  while (distance > 0.0 && k + step >= 0 && k + step < count)
  {
    distance -= (path.points[static_cast<std::size_t>(k + step)] - path.points[static_cast<std::size_t>(k)]).norm();
    k += step;
  }
  return path.points[static_cast<std::size_t>(k)];
}

/** Recognises a click at which the path returns through the lumen from which it came. */
bool turnsBack(const ClickPath& path, std::size_t click, double radius)
{
  double before = kBeside * radius;
  double after = kBeside * radius;
  pointBeside(path, click, -1, before);
  pointBeside(path, click, 1, after);
  double reach = kBeside * radius - std::max({before, after, 0.0});
  if (reach < kLeastBeside * radius)
    return false;
  double same = reach;
  const Eigen::Vector3d a = pointBeside(path, click, -1, reach);
  const Eigen::Vector3d b = pointBeside(path, click, 1, same);
  return (a - b).norm() < radius;
}

}  // namespace

void requireCourse(const ClickPath& path, const CheckedBranch& branch, bool is_alone, const std::string& file)
{
  // A click beside the axis gives too small a radius, one in the parent of a branch too large a one.
  double least = branch.clicks.front().radius;
  double largest = least;
  for (const LumenAtClick& click : branch.clicks)
  {
    least = std::min(least, click.radius);
    largest = std::max(largest, click.radius);
  }
  const double diameter = 2.0 * (is_alone ? largest : least);
  const double length = lengthOf(path.points);
  if (length < (is_alone ? kShortestAlone : kShortest) * diameter)
    throw InputError(file, branch.name,
                     "its clicks are only " + formatted("%.1f mm", 1e3 * length) + " apart in a lumen of " +
                         formatted("%.1f mm", 1e3 * diameter) + "; click near each end of a longer stretch");
  for (std::size_t k = 1; k + 1 < path.clicks.size(); ++k)
    if (turnsBack(path, path.clicks[k], branch.clicks[k].radius))
      throw InputError(
          file, branch.name,
          "the path turns back at click " + std::to_string(k + 1) +
              ", which is an end of a branch; give the clicks of a branch from one end to the other, and one "
              "branch per end (a list of end points, e.g. of SlicerVMTK, is no branch)");
}

}  // namespace endovascular_sim::segmentation
