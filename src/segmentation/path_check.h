#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "common/error.h"
#include "segmentation/lumen/click_check.h"
#include "segmentation/lumen/scan.h"

namespace endovascular_sim::segmentation
{

/** Path through the clicks of a branch. */
struct ClickPath
{
  std::vector<Eigen::Vector3d> points;  ///< grid frame [m]
  std::vector<std::size_t> clicks;      ///< index of the point of each click
};

/** A path returns to where it was before; another order of its clicks may help. */
class FoldedPath : public InputError
{
public:
  using InputError::InputError;
};

/** True if a path turns back at a click, or comes within one lumen radius of an earlier part of itself in the same
 * lumen.
 */
bool isFolded(const Scan& scan, const ClickPath& path, const CheckedBranch& branch);

/** Checks that a path leads from one end of a branch to the other.
 *  @param is_alone true for a vessel of one branch, which must be longer than one that continues others
 *  @param file of the clicks, in errors
 *  @throws InputError for a path that is shorter than the lumen is wide
 *  @throws FoldedPath for a path that turns back at a click */
void requireCourse(const ClickPath& path, const CheckedBranch& branch, bool is_alone, const std::string& file);

/** Checks that a path takes no detour through other vessels.
 *
 *  A path of up to twice the length of the polyline of its clicks is accepted. One of up to three times the length, as
 * a right coronary artery may have, is accepted if its lumen is that of the clicks: for nine tenths of the path the
 *  radius is at least 0.4 times that of the narrowest click, and within the bound of the widest one.
 *  @throws InputError for a longer path, with the farthest place from the clicks
 *  @throws FoldedPath for a path that comes within one lumen radius of an earlier part of itself in the same lumen,
 * with the place */
void requireDirect(const Scan& scan, const ClickPath& path, const CheckedBranch& branch, const std::string& file);

}  // namespace endovascular_sim::segmentation
