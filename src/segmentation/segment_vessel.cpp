#include "segmentation/segment_vessel.h"

#include <algorithm>
#include <cmath>

#include "common/error.h"
#include "common/numerics/parallel_for.h"
#include "common/text/format.h"
#include "segmentation/lumen/click_check.h"
#include "segmentation/lumen/minimal_path.h"
#include "segmentation/path_check.h"

namespace endovascular_sim::segmentation
{
namespace
{

constexpr double kWidestWithLimit = 0.01;  ///< radius up to which wide regions are closed to a path [m]
constexpr double kWideShare = 0.75;        ///< of the largest radius: radius of a wide region

WideRegions wideRegions(const Scan& scan, const CheckedBranch& branch)
{
  if (branch.largest_radius > kWidestWithLimit)
    return {};
  double darkest = branch.clicks.front().value;
  double brightest = darkest;
  for (const LumenAtClick& click : branch.clicks)
  {
    darkest = std::min(darkest, click.value);
    brightest = std::max(brightest, click.value);
  }
  const LumenRange range{darkest, brightest, branch.background};
  return {scan, range.threshold(), kWideShare * branch.largest_radius};
}

/** Path through all clicks of a branch. */
ClickPath pathOf(const Scan& scan, const ClickSet& clicks, const CheckedBranch& branch)
{
  const WideRegions wide = wideRegions(scan, branch);
  ClickPath result;
  result.points = {branch.clicks.front().position};
  result.clicks = {0};
  for (std::size_t k = 0; k + 1 < branch.clicks.size(); ++k)
  {
    const MinimalPath path =
        minimalPath(scan, branch.clicks[k].position, branch.clicks[k + 1].position, branch.range(k), wide);
    if (path.leavesLumen())
      throw InputError(clicks.file, branch.name,
                       "clicks " + std::to_string(k + 1) + " and " + std::to_string(k + 2) +
                           " lie in two vessels: the path between them leaves the contrast for " +
                           std::to_string(path.longest_gap * 1e3).substr(0, 4) + " mm at " +
                           inMillimetres(scan.toPatient(path.gap_location)) +
                           "; correct a click, add one between them, or end the branch at an occlusion");
    result.points.insert(result.points.end(), path.points.begin() + 1, path.points.end());
    result.clicks.push_back(result.points.size() - 1);
  }
  requireCourse(result, branch, clicks.branches.size() == 1, clicks.file);
  return result;
}

/** A path of several times the distance of its clicks has probably taken another vessel. The loop of a right coronary
 * artery has twice the distance. */
void warnOfDetour(const CheckedBranch& checked, const LumenBranch& branch, std::vector<std::string>& warnings)
{
  constexpr double kDetour = 3.0;
  double straight = 0.0;
  for (std::size_t k = 0; k + 1 < checked.clicks.size(); ++k)
    straight += (checked.clicks[k + 1].position - checked.clicks[k].position).norm();
  const double length = branch.arc().back();
  if (length > kDetour * straight)
    warnings.push_back(
        branch.name + ": the path has " + std::to_string(static_cast<int>(std::round(length / straight))) +
        " times the length of the straight line between the clicks; check that they lie in one vessel, or "
        "add a click between them");
}

/** Without an edge along any ray, or with a contour below the size of a voxel, the path has left the lumen, or the
 * vessel is occluded. The ends are left out: they may lie in the wider lumen of another branch. */
void warnOfVanishingLumen(const Scan& scan, const LumenBranch& branch, std::vector<std::string>& warnings)
{
  const std::vector<double> arc = branch.arc();
  for (std::size_t s = 0; s < branch.sections.size(); ++s)
  {
    const Section& section = branch.sections[s];
    const double to_end = std::min(arc[s], arc.back() - arc[s]);
    if ((section.edges > 0.0 || to_end < 2.0 * section.diameter()) && section.diameter() > scan.spacing().minCoeff())
      continue;
    warnings.push_back(branch.name + ": the lumen vanishes at " + inMillimetres(scan.toPatient(section.centre)) +
                       "; check the straightened view, add a click there, or end the branch before it");
    return;
  }
}

}  // namespace

Segmentation segmentBranches(const Scan& scan, const ClickSet& clicks, const EdgeSettings& settings, int threads,
                             const ProgressReport& progress)
{
  Segmentation result;
  reportProgress(progress, "checking the clicks");
  const std::vector<CheckedBranch> checked = checkClicks(scan, clicks, result.warnings);
  result.branches.resize(checked.size());
  reportProgress(progress, "segmenting the branches");
  parallelFor(checked.size(), threadCount(threads),
              [&](std::size_t b)
              {
                LumenBranch& branch = result.branches[b];
                branch.name = checked[b].name;
                branch.largest_radius = checked[b].largest_radius;
                branch.sections =
                    fitLumen(scan, pathOf(scan, clicks, checked[b]).points, checked[b].largest_radius, settings);
              });
  for (std::size_t b = 0; b < checked.size(); ++b)
  {
    warnOfDetour(checked[b], result.branches[b], result.warnings);
    warnOfVanishingLumen(scan, result.branches[b], result.warnings);
  }
  return result;
}

}  // namespace endovascular_sim::segmentation
