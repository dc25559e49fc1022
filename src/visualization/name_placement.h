#pragma once

#include <limits>
#include <string>
#include <vector>

#include <Eigen/Core>

namespace endovascular_sim::visualization
{

/** Projection of the scene into the picture. The axes are unit vectors, in the frame of the centreline. */
struct PictureView
{
  Eigen::Vector3d eye = Eigen::Vector3d::Zero();  ///< [m]
  Eigen::Vector3d right = Eigen::Vector3d::UnitX(), up = Eigen::Vector3d::UnitZ(), forward = Eigen::Vector3d::UnitY();
  double focal = 800.0;                                    ///< distance of the picture from the eye [pixels]
  double width = 1000.0, height = 700.0;                   ///< [pixels]
  double legend_width = 0.0, legend_height = 0.0;          ///< of the legends in the lower left corner [pixels]
  double reach = std::numeric_limits<double>::infinity();  ///< depth beyond which no branch has a name [m]

  double depth(const Eigen::Vector3d& point) const { return forward.dot(point - eye); }
  /** Place relative to the middle of the picture, to the right and up [pixels].
   *  @param point before the eye: its depth is positive */
  Eigen::Vector2d project(const Eigen::Vector3d& point) const
  {
    return focal / depth(point) * Eigen::Vector2d(right.dot(point - eye), up.dot(point - eye));
  }
};

/** Rectangle in the picture [pixels]. */
struct Rectangle
{
  Eigen::Vector2d low = Eigen::Vector2d::Zero(), high = Eigen::Vector2d::Zero();

  static Rectangle around(const Eigen::Vector2d& centre, const Eigen::Vector2d& size)
  {
    return {centre - 0.5 * size, centre + 0.5 * size};
  }
  Eigen::Vector2d centre() const { return 0.5 * (low + high); }
  /** Point of the rectangle that is nearest to another point. */
  Eigen::Vector2d nearest(const Eigen::Vector2d& point) const { return point.cwiseMax(low).cwiseMin(high); }
  double distance(const Eigen::Vector2d& point) const { return (nearest(point) - point).norm(); }
  bool overlaps(const Rectangle& other) const
  {
    return (low.array() < other.high.array()).all() && (other.low.array() < high.array()).all();
  }
};

/** Branch with the name that it gets in the picture. */
struct BranchToName
{
  std::string text;                                ///< empty: without a name
  Eigen::Vector2d size = Eigen::Vector2d::Zero();  ///< of the name in the picture [pixels]
  std::vector<Eigen::Vector3d> points;             ///< centreline, finite; without points the branch is not drawn [m]
  std::vector<double> radii;                       ///< at the points [m]
  bool comes_first = false;                        ///< true: its name has a place before those of all others
};

/** Name in the picture. A leader joins it to its branch. */
struct PlacedName
{
  std::string text;
  Eigen::Vector2d size = Eigen::Vector2d::Zero();    ///< [pixels]
  Eigen::Vector3d end = Eigen::Vector3d::Zero();     ///< of the leader, in the lumen of the branch [m]
  Eigen::Vector2d offset = Eigen::Vector2d::Zero();  ///< centre of the name, from the end of the leader [pixels]

  /** Place of the name in a view. @param view its eye is before the end of the leader */
  Rectangle box(const PictureView& view) const { return Rectangle::around(view.project(end) + offset, size); }
  /** Place of the name in a view, moved into the picture and out of the legends where these would cut it. */
  Rectangle boxInside(const PictureView& view) const;
};

/** Places the names of branches in the picture:
 *  - a leader ends in the lumen of its branch, where no other branch covers or crosses it;
 *  - of all branches in the picture the own one is the nearest to a name, measured to the drawn walls;
 *  - names overlap neither each other, nor leaders, nor the legends, and leaders do not cross.
 *
 *  A name is missing where no place satisfies this. It is also missing beside a branch that is shorter in the picture
 *  than the name is high. Branches that come first are followed by
 *  the longest ones in the picture.
 *  @param before names of an earlier view; a name keeps its offset where that is still possible */
std::vector<PlacedName> placeNames(const std::vector<BranchToName>& branches, const PictureView& view,
                                   const std::vector<PlacedName>& before = {});

}  // namespace endovascular_sim::visualization
