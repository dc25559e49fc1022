#include "segmentation/segment_vessel.h"

#include <algorithm>
#include <optional>

#include "common/numerics/parallel_for.h"
#include "common/text/format.h"
#include "segmentation/branch_path.h"
#include "segmentation/click_order.h"
#include "segmentation/lumen/click_check.h"
#include "segmentation/lumen/star_shape.h"
#include "segmentation/other_lumens.h"
#include "segmentation/path_check.h"
#include "segmentation/wider_lumen.h"

namespace endovascular_sim::segmentation
{
namespace
{

constexpr double kVanishing = 0.48;    ///< contrast in the middle, as a share of that of the lumen
constexpr double kWider = 1.6;         ///< bound of the radius, in radii of the widest part of a path
constexpr double kBoundMargin = 8e-4;  ///< [m]

/** Lumen of a branch along its clicks.
 *  @param warnings receives an order of the clicks that was changed */
LumenBranch lumenOf(const Scan& scan, const std::string& file, CheckedBranch checked, bool is_alone,
                    const EdgeSettings& settings, std::vector<std::string>& warnings)
{
  const ClickPath path = orderedPath(scan, checked, is_alone, file, warnings);
  LumenBranch branch;
  branch.name = checked.name;
  branch.largest_radius = checked.largest_radius;
  // A narrow click says nothing about the lumen far from it.
  if (const double widest = widestRadius(scan, path, checked); widest > branch.largest_radius && !checked.isBounded())
    branch.largest_radius = kWider * widest + kBoundMargin;
  branch.sections = fitLumen(scan, path.points, RayReach(branch.largest_radius), settings);
  return branch;
}

/** Without an edge along any ray, darker in the middle than an edge, or with a contour below the size of a voxel, the
 * path has left the lumen, or the vessel is occluded. The ends are left out: they may lie in the wider lumen of another
 * branch. */
std::optional<std::string> vanishingLumen(const Scan& scan, const LumenBranch& branch)
{
  const std::vector<double> arc = branch.arc();
  for (std::size_t s = 0; s < branch.sections.size(); ++s)
  {
    const Section& section = branch.sections[s];
    const double to_end = std::min(arc[s], arc.back() - arc[s]);
    const bool is_bright = section.edges() > 0.0 && section.middle > kVanishing;
    if ((is_bright || to_end < 2.0 * section.diameter()) && section.diameter() > scan.spacing().minCoeff())
      continue;
    return branch.name + ": the lumen vanishes at " + inMillimetres(scan.toPatient(section.centre)) +
           "; check the straightened view, add a click there, or end the branch before it";
  }
  return std::nullopt;
}

/** @throws InputError for a lumen of which rays from its middle see a part only */
void requireVisibleLumen(const Scan& scan, const LumenBranch& branch, const std::string& file)
{
  const std::optional<Stretch> hidden = hiddenStretch(branch);
  if (!hidden)
    return;
  const std::vector<double> arc = branch.arc();
  const auto at = std::lower_bound(arc.begin(), arc.end(), hidden->from) - arc.begin();
  throw InputError(
      file, branch.name,
      formatted("a bulge of the wall hides a part of the lumen from its middle at %.0f mm, ", 1e3 * hidden->from) +
          inMillimetres(scan.toPatient(branch.sections[static_cast<std::size_t>(at)].centre)) +
          " (a crescent, as of a dissection); end the branch before it, or give a mask of this lumen");
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
  std::vector<std::vector<std::string>> warnings(checked.size());
  parallelFor(checked.size(), threadCount(threads),
              [&](std::size_t b) {
                result.branches[b] = lumenOf(scan, clicks.file, checked[b], checked.size() == 1, settings, warnings[b]);
              });
  const std::vector<LumenBranch> first = result.branches;
  parallelFor(checked.size(), threadCount(threads),
              [&](std::size_t b)
              {
                reachEdges(scan, checked[b].given_radius, settings, otherLumens(first, b), clicks.file,
                           result.branches[b]);
                requireVisibleLumen(scan, result.branches[b], clicks.file);
              });
  for (std::size_t b = 0; b < checked.size(); ++b)
  {
    result.warnings.insert(result.warnings.end(), warnings[b].begin(), warnings[b].end());
    // Longer rays move a path away from the wall that it crosses.
    std::optional<std::string> vanishing = vanishingLumen(scan, first[b]);
    if (!vanishing)
      vanishing = vanishingLumen(scan, result.branches[b]);
    if (vanishing)
      result.warnings.push_back(*vanishing);
  }
  return result;
}

}  // namespace endovascular_sim::segmentation
