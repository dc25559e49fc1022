#include "segmentation/wider_lumen.h"

#include <algorithm>
#include <cmath>

#include "common/error.h"
#include "common/text/format.h"
#include "segmentation/lumen/lumen_fit.h"
#include "segmentation/lumen/median.h"

namespace endovascular_sim::segmentation
{
namespace
{

constexpr double kMostDoublings = 8.0;   ///< longest rays, in those of the first fit
constexpr double kLongest = 0.08;        ///< longest rays [m]
constexpr double kCornerShare = 0.04;    ///< of the circumference without an edge: two rays
constexpr double kWide = 8e-3;           ///< diameter of a lumen that may be dissected [m]
constexpr double kWidestAneurysm = 5.0;  ///< largest radius, in those of the branch

/** Description of a stretch for a message. */
std::string findingOf(const Scan& scan, const LumenBranch& branch, const OpenStretch& stretch)
{
  const std::vector<double> arc = branch.arc();
  const Section& middle = branch.sections[(stretch.first + stretch.last) / 2];
  return formatted(
             "has no edge of the lumen along %.0f %% of the circumference within %.1f mm from %.0f to %.0f mm, around ",
             100.0 * stretch.share, 1e3 * middle.reach, 1e3 * arc[stretch.first], 1e3 * arc[stretch.last]) +
         inMillimetres(scan.toPatient(middle.centre));
}

[[noreturn]] void refuse(const std::string& file, const LumenBranch& branch, const std::string& finding,
                         double largest_radius)
{
  const std::string remedy =
      largest_radius > 0.0
          ? "raise largest_radius of the branch, or end the branch before this place"
          : "give largest_radius of the branch in the clicks, the radius of the lumen at its widest place, or end the "
            "branch before this place";
  throw InputError(file, branch.name, finding + "; " + remedy);
}

/** Doubles the reach of a stretch and of its surroundings.
 *  @return false if no section may reach farther */
bool lengthen(const OpenStretch& stretch, double limit, LumenBranch& branch)
{
  const std::vector<double> arc = branch.arc();
  double reach = 0.0;
  for (std::size_t k = stretch.first; k <= stretch.last; ++k)
    reach = std::max(reach, branch.sections[k].reach);
  const double margin = std::max(kOpenLength, reach);
  reach = std::min(2.0 * reach, limit);
  bool is_longer = false;
  for (std::size_t k = 0; k < arc.size(); ++k)
  {
    double& own = branch.sections[k].reach;
    const bool is_near = arc[k] > arc[stretch.first] - margin && arc[k] < arc[stretch.last] + margin;
    if (!is_near || own >= reach)
      continue;
    is_longer = is_longer || (k >= stretch.first && k <= stretch.last);
    own = reach;
  }
  return is_longer;
}

void fitAgain(const Scan& scan, const EdgeSettings& settings, LumenBranch& branch)
{
  std::vector<Eigen::Vector3d> path;
  for (const Section& section : branch.sections)
    path.push_back(section.centre);
  branch.sections = fitLumen(scan, path, RayReach(branch.largest_radius, branch.sections), settings);
}

/** Doubles the reach once where a wide lumen lacks few edges: the rays do not reach the corners of a dissected lumen.
 *  @return false if nothing is longer */
bool lengthenOpenCorners(double limit, const OtherLumen& other, LumenBranch& branch)
{
  bool is_longer = false;
  for (const OpenStretch& stretch : openStretches(branch.sections, other, true, kCornerShare))
    if (branch.sections[(stretch.first + stretch.last) / 2].diameter() > kWide)
      is_longer = lengthen(stretch, limit, branch) || is_longer;
  return is_longer;
}

/** @throws InputError for a lumen that is too wide for an aneurysm: a chamber of the heart, another organ */
void requireAneurysm(const Scan& scan, double largest_radius, const std::string& file, const LumenBranch& branch)
{
  std::vector<double> radii;
  for (const Section& section : branch.sections)
    radii.push_back(0.5 * section.diameter());
  const double usual = median(radii);
  const std::vector<double> arc = branch.arc();
  for (std::size_t k = 0; k < branch.sections.size(); ++k)
    if (const Section& section = branch.sections[k];
        section.reach > branch.largest_radius && 0.5 * section.diameter() > kWidestAneurysm * usual)
      refuse(file, branch,
             formatted("its lumen widens from %.1f to %.1f mm at %.0f mm, ", 2e3 * usual, 1e3 * section.diameter(),
                       1e3 * arc[k]) +
                 inMillimetres(scan.toPatient(section.centre)) + ", as into a chamber of the heart",
             largest_radius);
}

}  // namespace

void reachEdges(const Scan& scan, double largest_radius, const EdgeSettings& settings, const OtherLumen& other,
                const std::string& file, LumenBranch& branch)
{
  const double limit =
      largest_radius > 0.0 ? largest_radius : std::min(kMostDoublings * branch.largest_radius, kLongest);
  const bool is_longer = lengthenOpenCorners(limit, other, branch);
  if (is_longer)
    fitAgain(scan, settings, branch);
  bool is_wider = false;
  for (std::vector<OpenStretch> open = openStretches(branch.sections, other); !open.empty();
       open = openStretches(branch.sections, other))
  {
    bool any = false;
    for (const OpenStretch& stretch : open)
      any = lengthen(stretch, limit, branch) || any;
    if (!any)
      refuse(file, branch, findingOf(scan, branch, open.front()), largest_radius);
    fitAgain(scan, settings, branch);
    is_wider = true;
  }
  if (is_wider)
    requireAneurysm(scan, largest_radius, file, branch);
}

}  // namespace endovascular_sim::segmentation
