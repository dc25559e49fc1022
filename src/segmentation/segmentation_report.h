#pragma once

#include <string>
#include <vector>

#include "segmentation/branch_verdict.h"
#include "segmentation/lumen/scan.h"
#include "segmentation/lumen/section.h"

namespace endovascular_sim::segmentation
{

/** Findings along one branch. */
struct BranchFindings
{
  std::string name;
  std::string parent;                 ///< empty at the root
  double length = 0.0;                ///< [m]
  double volume = 0.0;                ///< of the lumen [m³]
  double first_diameter = 0.0;        ///< mean of the first tenth [m]
  double last_diameter = 0.0;         ///< mean of the last tenth [m]
  Throat throat;                      ///< narrowest place
  double lumen = 0.0;                 ///< median value of the lumen
  double rays_without_edge = 0.0;     ///< share
  std::vector<Stretch> without_edge;  ///< more than 30 % of the rays have no edge there
  std::vector<Stretch> calcium;       ///< calcium borders on the lumen there
  std::vector<Stretch> bone;          ///< bone lies behind a soft gap there
  std::vector<Stretch> turns;         ///< the path turns there
  BranchVerdict verdict;
};

/** @param warnings of the segmentation, which the verdict takes into account */
BranchFindings findingsOf(const Scan& scan, const std::vector<LumenBranch>& branches, std::size_t branch,
                          const std::vector<std::string>& warnings);

/** Report of a segmentation in JSON, SI units; per branch its findings, and arc length, diameter and value of the lumen
 * of all sections. It holds no name, number or date of the patient. */
std::string segmentationJson(const Scan& scan, const std::vector<LumenBranch>& branches,
                             const std::vector<std::string>& warnings);

/** Table of the findings, in millimetres, and a line per branch with its verdict and the reasons. */
std::string segmentationText(const Scan& scan, const std::vector<LumenBranch>& branches,
                             const std::vector<std::string>& warnings);

}  // namespace endovascular_sim::segmentation
