#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "segmentation/lumen/path_turns.h"
#include "segmentation/lumen/scan.h"
#include "segmentation/lumen/section.h"

namespace endovascular_sim::segmentation
{

/** Shares of the circumference, in the mean over 3 mm, from which a contour is doubtful or unknown there. @{ */
constexpr double kDoubtfulShare = 0.2;
constexpr double kUnknownShare = 0.4;
/** @} */

/** Share of the circumference beside calcium, in the mean over 3 mm, from which a contour is doubtful. */
constexpr double kCalciumShare = 0.25;

/** Diameter of a throat below which the image resolves it poorly [voxels]. */
constexpr double kThroatVoxels = 3.0;

/** Diameter of a throat below which the image does not resolve it [voxels]. */
constexpr double kLostVoxels = 1.0;

/** Narrowest place of a branch. */
struct Throat
{
  double diameter = 0.0;                               ///< [m]
  double at = 0.0;                                     ///< arc length [m]
  Eigen::Vector3d position = Eigen::Vector3d::Zero();  ///< patient frame [m]
  double voxels = 0.0;                                 ///< diameter in voxels (cube root of their volume)
  double error = 0.0;                                  ///< expected error of the diameter [m]
};

/** Expected error of the diameter of a throat [m]: σ (0.3 + 1.4 exp(−d/(2σ))), the upper bound of the errors that
 *  synthetic stenoses of 50 to 90 % have with noise up to 40 HU. Throats are too wide rather than too narrow.
 *  @param diameter d, as measured [m]
 *  @param blur σ, standard deviation of scanner, voxel and interpolation [m] */
double throatError(double diameter, double blur);

Throat throatOf(const Scan& scan, const LumenBranch& branch);

/** Warnings of throats below kThroatVoxels, one per branch. Noise does not matter for them. */
std::vector<std::string> throatWarnings(const Scan& scan, const std::vector<LumenBranch>& branches);

/** Use that a branch is fit for. */
enum class Use
{
  kUse,       ///< nothing doubtful was found
  kLook,      ///< the straightened view must be looked at
  kDoNotUse,  ///< the contour is unknown somewhere
};

/** Name of a use: "use", "look", "do not use". */
std::string nameOf(Use use);

/** Verdict on one branch. */
struct BranchVerdict
{
  Use use = Use::kUse;
  std::vector<std::string> reasons;
};

/** Judges a branch by the constants above. A warning that begins with the name of the branch is a reason to
 *  look, unless the constants give the same reason. */
BranchVerdict verdictOf(const Scan& scan, const std::vector<LumenBranch>& branches, std::size_t branch,
                        const std::vector<std::string>& warnings);

}  // namespace endovascular_sim::segmentation
