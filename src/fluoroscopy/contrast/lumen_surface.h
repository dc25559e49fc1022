#pragma once

#include <Eigen/Core>

#include <algorithm>
#include <vector>

#include "contrast/lumen/lumen_cells.h"
#include "fluoroscopy/projection/covered_pixels.h"
#include "fluoroscopy/projection/signed_depth.h"

namespace endovascular_sim::fluoroscopy
{

/** Plane of a triangle of the wall: inverse depth over the pixels of the image. */
class DepthPlane
{
public:
  DepthPlane(const Corner& a, const Corner& b, const Corner& c);

  /** False for a triangle that is seen edge-on. */
  bool valid() const { return valid_; }

  /** Inverse depth at a pixel, limited to that of the triangle [1/m]. */
  double at(int row, int column) const
  {
    return std::clamp(at_origin_ + along_rows_ * row + along_columns_ * column, least_, most_);
  }

private:
  bool valid_ = false;
  double at_origin_ = 0.0, along_rows_ = 0.0, along_columns_ = 0.0, least_ = 0.0, most_ = 0.0;
};

/** Visits the pixels in front of a piece of the wall. Its depths are those of the whole triangle: the depths of all
 *  pieces add up to those of the uncut wall.
 *  @param plane of the whole triangle
 *  @param visit see coveredPixels() */
template <typename Visit>
void coveredByPiece(const Corner& a, const Corner& b, const Corner& c, const DepthPlane& plane, int pixels,
                    const Visit& visit)
{
  coveredPixels(a, b, c, pixels,
                [&](int row, int column, double inverse_depth, double sign)
                { visit(row, column, plane.valid() ? plane.at(row, column) : inverse_depth, sign); });
}

/** The same for any piece, also one that no plane cuts.
 *  @param corners of all vertices in the image */
template <typename Visit>
void coveredByPiece(const contrast::LumenCells& lumen, const contrast::WallPiece& piece,
                    const std::vector<Corner>& corners, int pixels, const Visit& visit)
{
  const auto corner = [&corners](int vertex) -> const Corner& { return corners[static_cast<std::size_t>(vertex)]; };
  const Eigen::Vector3i& own = piece.corners;
  const Eigen::Vector3i& whole = lumen.triangles[static_cast<std::size_t>(piece.triangle)];
  const Corner &a = corner(own[0]), &b = corner(own[1]), &c = corner(own[2]);
  if (own == whole ||
      firstPixel(std::min({a.row, b.row, c.row})) > lastPixel(std::max({a.row, b.row, c.row}), pixels) ||
      firstPixel(std::min({a.column, b.column, c.column})) >
          lastPixel(std::max({a.column, b.column, c.column}), pixels))
    return coveredPixels(a, b, c, pixels, visit);
  coveredByPiece(a, b, c, DepthPlane(corner(whole[0]), corner(whole[1]), corner(whole[2])), pixels, visit);
}

}  // namespace endovascular_sim::fluoroscopy
