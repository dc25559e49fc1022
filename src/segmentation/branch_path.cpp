#include "segmentation/branch_path.h"

#include <algorithm>
#include <optional>
#include <vector>

#include "common/error.h"
#include "common/text/format.h"
#include "segmentation/lumen/local_lumen.h"
#include "segmentation/lumen/minimal_path.h"
#include "segmentation/lumen/wall_crossing.h"
#include "segmentation/lumen/wide_regions.h"

namespace endovascular_sim::segmentation
{
namespace
{

constexpr double kWidestWithLimit = 0.01;  ///< bound of the radius up to which wide regions are closed to a path [m]
constexpr double kWideShare = 0.75;        ///< of the bound: radius of a wide region
constexpr double kSameBound = 0.1;         ///< relative difference of bounds that share their wide regions
constexpr double kDetour = 1.5;            ///< length of a path, in straight lines, that may have been diverted
constexpr double kShorter = 0.8;           ///< length of a path without closed regions that replaces a longer one
constexpr double kClose = 0.01;            ///< distance of two clicks that confirm a narrow place [m]
constexpr double kCloseRadii = 5.0;        ///< likewise, in radii of the lumen
constexpr double kSampled = 2e-3;          ///< distance of the places at which the width is measured [m]
constexpr double kAsWide = 0.75;           ///< share of a radius that counts as equally wide

/** Finds the path of one branch. */
class PathFinder
{
public:
  PathFinder(const Scan& scan, const CheckedBranch& branch, const std::string& file)
    : scan_(scan), branch_(branch), file_(file)
  {
  }

  ClickPath run()
  {
    std::vector<Stretch> stretches;
    for (std::size_t k = 0; k + 1 < branch_.clicks.size(); ++k)
      stretches.push_back(stretch(k));
    ClickPath path = joined(stretches);
    const auto crossing = std::find_if(stretches.begin(), stretches.end(), [](const Stretch& s) { return s.crossing; });
    if (crossing == stretches.end())
      return path;
    if (!isFolded(scan_, path, branch_))
      throw crossesWall(static_cast<std::size_t>(crossing - stretches.begin()), crossing->crossing->location);
    // A click on a loop, whose path returns after it has crossed the neck, says that the loop is the way.
    for (std::size_t k = 0; k < stretches.size(); ++k)
      if (!avoidWall(k, stretches[k]))
        return path;
    const ClickPath around = joined(stretches);
    return isFolded(scan_, around, branch_) ? path : around;
  }

private:
  /** Path between two successive clicks. */
  struct Stretch
  {
    MinimalPath path;
    std::optional<WallCrossing> crossing;  ///< that no clicks confirm as a narrow place
  };

  Stretch stretch(std::size_t k)
  {
    const Eigen::Vector3d& from = branch_.clicks[k].position;
    const Eigen::Vector3d& to = branch_.clicks[k + 1].position;
    const LumenRange range = branch_.range(k);
    Stretch found{minimalPath(scan_, from, to, range, wideRegions(k)), std::nullopt};
    found.crossing = crossingOf(found.path, k);
    const bool is_wrong = found.path.leavesLumen() || found.crossing;
    if (is_wrong || found.path.length() > kDetour * (to - from).norm())
    {
      MinimalPath open = minimalPath(scan_, from, to, range, {});
      const double most = (is_wrong ? 1.0 : kShorter) * found.path.length();
      if (!open.leavesLumen() && open.length() < most && !crossingOf(open, k))
        return {open, std::nullopt};
    }
    if (found.path.leavesLumen())
      throw InputError(file_, branch_.name,
                       clickNumbers(k) + " lie in two vessels: the path between them leaves the contrast for " +
                           inMillimetres(found.path.longest_gap) + " at " +
                           inMillimetres(scan_.toPatient(found.path.gap_location)) +
                           "; correct a click, add one between them, or end the branch at an occlusion");
    return found;
  }

  /** Replaces a path that crosses a wall by one on another way.
   *  @return false if there is none */
  bool avoidWall(std::size_t k, Stretch& stretch)
  {
    if (!stretch.crossing)
      return true;
    stretch.path = minimalPath(scan_, branch_.clicks[k].position, branch_.clicks[k + 1].position, branch_.range(k),
                               wideRegions(k), stretch.crossing->bright);
    return !stretch.path.points.empty() && !stretch.path.leavesLumen() && !crossingOf(stretch.path, k);
  }

  ClickPath joined(const std::vector<Stretch>& stretches) const
  {
    ClickPath result;
    result.points = {branch_.clicks.front().position};
    result.clicks = {0};
    for (const Stretch& stretch : stretches)
    {
      const std::vector<Eigen::Vector3d>& points = stretch.path.points;
      result.points.insert(result.points.end(), points.begin() + 1, points.end());
      result.clicks.push_back(result.points.size() - 1);
    }
    return result;
  }

  InputError crossesWall(std::size_t k, const Eigen::Vector3d& place) const
  {
    return {
        file_, branch_.name,
        "the path between " + clickNumbers(k) + " crosses a dark place at " + inMillimetres(scan_.toPatient(place)) +
            ", probably the wall between two lumens that touch, e.g. at the neck of a loop; add a click on the right "
            "way, or, if one vessel is narrow there, two clicks close to the place, one on each side"};
  }

  /** Crossing of a wall that no clicks confirm as a narrow place. */
  std::optional<WallCrossing> crossingOf(const MinimalPath& path, std::size_t k) const
  {
    const std::optional<WallCrossing> crossing = wallCrossing(scan_, path.points, branch_.range(k));
    const bool is_between_inner_clicks = k > 0 && k + 2 < branch_.clicks.size();
    if (!crossing || !is_between_inner_clicks)
      return crossing;
    const double radius = std::min(branch_.clicks[k].radius, branch_.clicks[k + 1].radius);
    const double apart = (branch_.clicks[k + 1].position - branch_.clicks[k].position).norm();
    return apart < std::max(kClose, kCloseRadii * radius) ? std::nullopt : crossing;
  }

  /** Regions that are wider than the lumen at two successive clicks. */
  const WideRegions& wideRegions(std::size_t k)
  {
    const double bound = branch_.radiusBound(k);
    if (bound > kWidestWithLimit)
      return none_;
    if (bound_ <= 0.0 || std::abs(bound - bound_) > kSameBound * bound_)
    {
      wide_ = WideRegions(scan_, branch_.range(k).threshold(), kWideShare * bound);
      bound_ = bound;
    }
    return wide_;
  }

  static std::string clickNumbers(std::size_t first)
  {
    return "clicks " + std::to_string(first + 1) + " and " + std::to_string(first + 2);
  }

  const Scan& scan_;
  const CheckedBranch& branch_;
  const std::string& file_;
  WideRegions none_;
  WideRegions wide_;    ///< of the last stretch that needed them
  double bound_ = 0.0;  ///< theirs [m]; 0: none yet
};

}  // namespace

ClickPath branchPath(const Scan& scan, const CheckedBranch& branch, const std::string& file)
{
  return PathFinder(scan, branch, file).run();
}

double widestRadius(const Scan& scan, const ClickPath& path, const CheckedBranch& branch)
{
  std::vector<double> radii;
  double passed = kSampled;
  for (std::size_t k = 0; k < path.points.size(); ++k)
  {
    passed += k > 0 ? (path.points[k] - path.points[k - 1]).norm() : 0.0;
    if (passed < kSampled)
      continue;
    passed = 0.0;
    radii.push_back(lumenRadius(scan, path.points[k], branch.wholeRange().threshold()));
  }
  std::sort(radii.begin(), radii.end());
  for (std::size_t k = radii.size(); k-- > 0;)
  {
    const auto as_wide = radii.end() - std::lower_bound(radii.begin(), radii.end(), kAsWide * radii[k]);
    if (kSampled * static_cast<double>(as_wide) > 2.0 * radii[k])
      return radii[k];
  }
  return 0.0;
}

}  // namespace endovascular_sim::segmentation
