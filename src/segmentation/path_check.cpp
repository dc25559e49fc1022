#include "segmentation/path_check.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "common/text/format.h"
#include "segmentation/lumen/local_lumen.h"
#include "segmentation/lumen/minimal_path.h"

namespace endovascular_sim::segmentation
{
namespace
{

constexpr double kShortest = 1.0;       ///< length of a path, in diameters of the lumen
constexpr double kShortestAlone = 1.6;  ///< likewise, of a vessel of one branch: below, its cut ends meet
constexpr double kBeside = 4.0;       ///< distance along the path at which both sides of a click are compared, in radii
constexpr double kLeastBeside = 2.0;  ///< least one, where the path is short, in radii
constexpr double kLong = 2.0;         ///< length of a path that needs no evidence, in lengths of the polyline of clicks
constexpr double kLongest = 3.0;      ///< likewise, with evidence
constexpr double kNarrowest = 0.4;    ///< least radius of the lumen along a long path, in radii at the narrowest click
constexpr double kOtherLumen = 0.1;   ///< largest share of a long path in another lumen
constexpr int kMedian = 2;            ///< places on both sides in the median of the radius
constexpr double kSampled = 2e-3;     ///< distance of places along a path [m]
constexpr double kLoop = 4.0;         ///< least length of the path between two places of a return, in radii
constexpr double kSameLumen = 0.75;   ///< least value between them, in contrasts

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

/** Indices of points of a path about 2 mm apart. */
std::vector<std::size_t> placesOf(const ClickPath& path)
{
  std::vector<std::size_t> places;
  double passed = kSampled;
  for (std::size_t k = 0; k < path.points.size(); ++k)
  {
    passed += k > 0 ? (path.points[k] - path.points[k - 1]).norm() : 0.0;
    if (passed < kSampled)
      continue;
    passed = 0.0;
    places.push_back(k);
  }
  return places;
}

/** True if the lumen along a path is about as wide as at the clicks. */
bool isInLumenOfClicks(const Scan& scan, const ClickPath& path, const CheckedBranch& branch)
{
  double least = branch.clicks.front().radius;
  double most = 0.0;
  for (std::size_t k = 0; k < branch.clicks.size(); ++k)
  {
    least = std::min(least, branch.clicks[k].radius);
    if (k + 1 < branch.clicks.size())
      most = std::max(most, branch.radiusBound(k));
  }
  const double threshold = branch.wholeRange().threshold();
  std::vector<double> radii;
  for (const std::size_t place : placesOf(path))
    radii.push_back(lumenRadius(scan, path.points[place], threshold));
  const auto n = static_cast<int>(radii.size());
  int others = 0;
  for (int k = 0; k < n; ++k)
  {
    std::vector<double> near(radii.begin() + std::max(0, k - kMedian), radii.begin() + std::min(n, k + kMedian + 1));
    const double radius = quantile(near, 0.5);
    others += radius < kNarrowest * least || radius > most ? 1 : 0;
  }
  return others <= kOtherLumen * n;
}

/** Point of a path that is farthest from all clicks. */
Eigen::Vector3d farthestFromClicks(const ClickPath& path, const CheckedBranch& branch)
{
  Eigen::Vector3d farthest = path.points.front();
  double most = -1.0;
  for (const Eigen::Vector3d& p : path.points)
  {
    double least = 1e30;
    for (const LumenAtClick& click : branch.clicks)
      least = std::min(least, (click.position - p).norm());
    if (least > most)
    {
      most = least;
      farthest = p;
    }
  }
  return farthest;
}

/** True if the straight line between two points lies in one lumen. */
bool isInOneLumen(const Scan& scan, const Eigen::Vector3d& a, const Eigen::Vector3d& b, double least)
{
  constexpr int kSteps = 10;
  for (int k = 0; k <= kSteps; ++k)
    if (scan.at(a + (b - a) * k / kSteps) < least)
      return false;
  return true;
}

/** Place at which a path comes back to an earlier part of itself. */
struct Return
{
  std::size_t point = 0;
  double length = 0.0;  ///< of the path in between [m]
};

std::optional<Return> returnOf(const Scan& scan, const ClickPath& path, const CheckedBranch& branch)
{
  std::vector<double> arc{0.0};
  for (std::size_t k = 1; k < path.points.size(); ++k)
    arc.push_back(arc.back() + (path.points[k] - path.points[k - 1]).norm());
  const auto radiusOf = [&](std::size_t point)
  {
    std::size_t k = 0;
    while (k + 2 < path.clicks.size() && path.clicks[k + 1] < point)
      ++k;
    return std::min(branch.clicks[k].radius, branch.clicks[k + 1].radius);
  };
  const LumenRange range = branch.wholeRange();
  const double least = range.background + kSameLumen * (range.low - range.background);
  for (std::size_t k = 0; k < path.points.size(); ++k)
  {
    const double own = radiusOf(k);
    for (std::size_t q = 0; q < k && arc[k] - arc[q] > kLoop * own; ++q)
      if ((path.points[k] - path.points[q]).norm() < std::min(own, radiusOf(q)) &&
          isInOneLumen(scan, path.points[k], path.points[q], least))
        return Return{k, arc[k] - arc[q]};
  }
  return std::nullopt;
}

/** Number of the first click, from 1, at which a path turns back; 0 without one. */
std::size_t turningClick(const ClickPath& path, const CheckedBranch& branch)
{
  for (std::size_t k = 1; k + 1 < path.clicks.size(); ++k)
    if (turnsBack(path, path.clicks[k], branch.clicks[k].radius))
      return k + 1;
  return 0;
}

}  // namespace

bool isFolded(const Scan& scan, const ClickPath& path, const CheckedBranch& branch)
{
  return turningClick(path, branch) > 0 || returnOf(scan, path, branch);
}

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
  if (const std::size_t click = turningClick(path, branch); click > 0)
    throw FoldedPath(
        file, branch.name,
        "the path turns back at click " + std::to_string(click) +
            ", which is an end of a branch; give the clicks of a branch from one end to the other, and one "
            "branch per end (name a list of end points, e.g. of SlicerVMTK, Endpoints, to get a branch per end)");
}

void requireDirect(const Scan& scan, const ClickPath& path, const CheckedBranch& branch, const std::string& file)
{
  if (const std::optional<Return> back = returnOf(scan, path, branch))
    throw FoldedPath(file, branch.name,
                     "the path returns at " + inMillimetres(scan.toPatient(path.points[back->point])) + " after " +
                         inMillimetres(back->length) +
                         " to where it was before; give the clicks of a branch from one end to the other, or add a "
                         "click on the right way");
  double polyline = 0.0;
  for (std::size_t k = 0; k + 1 < branch.clicks.size(); ++k)
    polyline += (branch.clicks[k + 1].position - branch.clicks[k].position).norm();
  const double length = lengthOf(path.points);
  if (length <= kLong * polyline || (length <= kLongest * polyline && isInLumenOfClicks(scan, path, branch)))
    return;
  throw InputError(file, branch.name,
                   "the path is " + inMillimetres(length) + " long, " + formatted("%.1f", length / polyline) +
                       " times the distance of its clicks, and leads through " +
                       inMillimetres(scan.toPatient(farthestFromClicks(path, branch))) +
                       "; add a click between them, on the right way");
}

}  // namespace endovascular_sim::segmentation
