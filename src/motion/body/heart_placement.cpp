#include "motion/body/heart_placement.h"

#include <algorithm>
#include <limits>
#include <vector>

#include <Eigen/Geometry>

#include "common/error.h"
#include "common/text/format.h"
#include "common/text/words.h"

namespace endovascular_sim::motion
{
namespace
{

using Eigen::Vector3d;

constexpr double kSearchRadius = 0.4;   // for the centre of the fade, in lengths of the axis
constexpr int kSearchSteps = 5;         // of the centre of the fade, to either side
constexpr double kLeastAxis = 0.02;     // [m]
constexpr double kNearlyEqual = 1e-12;  // mean weights that differ by less are equal

/** Middle of a segment of a centreline. */
struct Piece
{
  Vector3d middle;      ///< [m]
  double length = 0.0;  ///< [m]
  double radius = 0.0;  ///< of the lumen [m]
};

int branchOf(const vessel::CentrelineTree& tree, const std::string& name, const std::string& key,
             const MotionSource& source)
{
  std::vector<std::string> names;
  for (std::size_t k = 0; k < tree.branches.size(); ++k)
  {
    names.push_back(tree.branches[k].name);
    if (names.back() == name && !tree.branches[k].points.empty())
      return static_cast<int>(k);
  }
  throw InputError(source.file, source.prefix + "region." + key,
                   "the vessel has no branch \"" + name + "\"; " + suggestion(name, names, "its branches are") +
                       "; name one of them, or use a vessel with named coronary arteries");
}

void addPieces(const vessel::CentrelineBranch& branch, std::vector<Piece>& pieces)
{
  for (std::size_t k = 1; k < branch.points.size(); ++k)
  {
    const double radius = k < branch.radii.size() ? std::max(branch.radii[k - 1], branch.radii[k]) : 0.0;
    pieces.push_back(
        {0.5 * (branch.points[k - 1] + branch.points[k]), (branch.points[k] - branch.points[k - 1]).norm(), radius});
  }
}

/** Pieces of two branches and of all that spring from them. */
std::vector<Piece> coronaryPieces(const vessel::CentrelineTree& tree, int left, int right)
{
  std::vector<Piece> pieces;
  for (std::size_t k = 0; k < tree.branches.size(); ++k)
  {
    int above = static_cast<int>(k);
    while (above >= 0 && above != left && above != right)
      above = tree.branches[static_cast<std::size_t>(above)].parent;
    if (above >= 0)
      addPieces(tree.branches[k], pieces);
  }
  return pieces;
}

Vector3d meanOf(const std::vector<Piece>& pieces)
{
  Vector3d sum = Vector3d::Zero();
  double length = 0.0;
  for (const Piece& piece : pieces)
  {
    sum += piece.length * piece.middle;
    length += piece.length;
  }
  return sum / length;
}

/** Distance from a point to the nearest wall of fixed pieces [m]; infinite without one. */
double clearance(const std::vector<Piece>& fixed, const Vector3d& point)
{
  double least = std::numeric_limits<double>::infinity();
  for (const Piece& piece : fixed)
    least = std::min(least, (piece.middle - point).norm() - 0.5 * piece.length - piece.radius);
  return least;
}

/** Mean weight of pieces in a fade [1]. */
double meanWeight(const std::vector<Piece>& pieces, const Fade& fade)
{
  double sum = 0.0, length = 0.0;
  for (const Piece& piece : pieces)
  {
    const double square = (piece.middle - fade.centre).squaredNorm() - fade.core * fade.core;
    const double t = std::clamp(square / (fade.reach * fade.reach - fade.core * fade.core), 0.0, 1.0);
    sum += piece.length * (1.0 - t * t * t * (10.0 - t * (15.0 - 6.0 * t)));
    length += piece.length;
  }
  return sum / length;
}

/** Directions of the search: along the axis, away from the fixed branches, and across both. They turn with the vessel.
 */
Eigen::Matrix3d searchDirections(const Vector3d& axis, const Vector3d& away)
{
  const Vector3d across = away - away.dot(axis) * axis;
  Eigen::Matrix3d directions;
  directions.col(0) = axis;
  directions.col(1) = across.norm() > 1e-9 ? Vector3d(across.normalized()) : axis.unitOrthogonal();
  directions.col(2) = axis.cross(directions.col(1));
  return directions;
}

/** Largest fade of a width around a centre that leaves the fixed pieces out. */
Fade largestFade(const std::vector<Piece>& fixed, const std::vector<Piece>& heart, const Vector3d& centre, double width)
{
  double farthest = 0.0;
  for (const Piece& piece : heart)
    farthest = std::max(farthest, (piece.middle - centre).norm() + 0.5 * piece.length + piece.radius);
  const double reach = std::min(clearance(fixed, centre), farthest + width);
  return {centre, reach - width, reach};
}

Fade fittedFade(const std::vector<Piece>& fixed, const std::vector<Piece>& heart, const HeartFrame& frame, double width)
{
  const Vector3d mean = meanOf(heart);
  const Eigen::Matrix3d directions =
      searchDirections(frame.axis, fixed.empty() ? frame.axis : Vector3d(mean - meanOf(fixed)));
  Fade best;
  double largest = 0.0;
  for (int i = -kSearchSteps; i <= kSearchSteps; ++i)
    for (int j = -kSearchSteps; j <= kSearchSteps; ++j)
      for (int k = -kSearchSteps; k <= kSearchSteps; ++k)
      {
        if (i * i + j * j + k * k > kSearchSteps * kSearchSteps)
          continue;
        const Vector3d offset = kSearchRadius * frame.length / kSearchSteps * Vector3d(i, j, k);
        const Fade fade = largestFade(fixed, heart, mean + directions * offset, width);
        const double weight = fade.core > 0.0 ? meanWeight(heart, fade) : 0.0;
        if (weight > largest + kNearlyEqual)
        {
          largest = weight;
          best = fade;
        }
      }
  return best;
}

}  // namespace

HeartFrame placeHeart(const vessel::CentrelineTree& tree, const MotionRegion& region, const MotionSource& source)
{
  const int left = branchOf(tree, region.left_ostium, "left_ostium", source);
  const int right = branchOf(tree, region.right_ostium, "right_ostium", source);
  const int end = branchOf(tree, region.apex_branch, "apex_branch", source);
  const auto branch = [&tree](int k) -> const vessel::CentrelineBranch&
  { return tree.branches[static_cast<std::size_t>(k)]; };
  HeartFrame frame;
  frame.base = region.base.value_or(0.5 * (branch(left).points.front() + branch(right).points.front()));
  const Vector3d apex = region.apex.value_or(branch(end).points.back());
  frame.length = (apex - frame.base).norm();
  if (frame.length < kLeastAxis)
    throw InputError(source.file, source.prefix + "region.apex_branch",
                     "its end is " + inMillimetres(frame.length) +
                         " from the ostia; give the branch that ends at the "
                         "apex, or region.base and region.apex");
  frame.axis = (apex - frame.base) / frame.length;
  std::vector<Piece> fixed;
  for (std::size_t k = 0; k < region.fixed.size(); ++k)
    addPieces(branch(branchOf(tree, region.fixed[k], formatted("fixed.%zu.branch", k), source)), fixed);
  const std::vector<Piece> heart = coronaryPieces(tree, left, right);
  frame.fade = region.centre ? Fade{*region.centre, region.core, region.core + region.fade}
                             : fittedFade(fixed, heart, frame, region.fade);
  if (!(frame.fade.core > 0.0))
    throw InputError(source.file, source.prefix + "region.fade",
                     "there is no room for a fade of " + inMillimetres(region.fade) +
                         " between the coronary arteries and "
                         "the branches of region.fixed; give a smaller fade of at least " +
                         inMillimetres(kLeastFade) + ", or fewer fixed branches");
  if (clearance(fixed, frame.fade.centre) < frame.fade.reach * (1.0 - 1e-9))
    throw InputError(source.file, source.prefix + "region.core",
                     "the fade around region.centre reaches a branch of region.fixed, which is " +
                         inMillimetres(clearance(fixed, frame.fade.centre)) +
                         " from the centre; core + fade must be less");
  return frame;
}

}  // namespace endovascular_sim::motion
