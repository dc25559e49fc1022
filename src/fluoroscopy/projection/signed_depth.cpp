#include "fluoroscopy/projection/signed_depth.h"

#include <algorithm>
#include <cmath>

#include "common/error.h"

namespace endovascular_sim::fluoroscopy
{
namespace
{

constexpr int kSubpixelBits = 12;
constexpr std::int64_t kSubpixels = std::int64_t{1} << kSubpixelBits;
constexpr double kMaxCoordinate = 1 << 29;  // products of coordinate differences fit into 62 bits
constexpr double kNearest = 0.02;           // minimum depth of a vertex, as a fraction of SID

/** Edge function: twice the signed area of the triangle (a, b, (column, row)); positive if clockwise on the screen. */
std::int64_t edgeFunction(const Corner& a, const Corner& b, std::int64_t column, std::int64_t row)
{
  return (b.column - a.column) * (row - a.row) - (b.row - a.row) * (column - a.column);
}

/** Fill-rule bias: 0 if samples exactly on the edge a → b belong to the triangle, else 1. It is equivalent to a shift
 *  of all samples by (ε, ε²), after which no sample lies on an edge. */
std::int64_t edgeBias(const Corner& a, const Corner& b)
{
  const bool inside = b.row < a.row || (b.row == a.row && b.column > a.column);
  return inside ? 0 : 1;
}

int firstPixel(std::int64_t subpixel)
{
  return static_cast<int>((std::max<std::int64_t>(subpixel, 0) + kSubpixels - 1) >> kSubpixelBits);
}

int lastPixel(std::int64_t subpixel, int pixels)
{
  return subpixel < 0 ? -1 : static_cast<int>(std::min<std::int64_t>(subpixel >> kSubpixelBits, pixels - 1));
}

}  // namespace

Corner projectCorner(const XRayGeometry& geometry, const Eigen::Vector3d& vertex)
{
  const Eigen::Vector3d p = geometry.toOptical(vertex);
  const double scale = geometry.focalLength() * kSubpixels;
  const double offset = geometry.centre() * kSubpixels;
  const double column = offset + scale * p.x() / p.z();
  const double row = offset - scale * p.y() / p.z();
  if (!(p.z() >= kNearest * geometry.pose().source_to_detector) || !(std::abs(column) < kMaxCoordinate) ||
      !(std::abs(row) < kMaxCoordinate))
    throw InputError(
        "C-arm", "isocentre",
        "the vessel extends to the X-ray source; move the isocentre or increase distance_source_to_patient");
  return {std::llround(column), std::llround(row), 1.0 / p.z()};
}

void addTriangle(const Corner& a, const Corner& second, const Corner& third, double detector_depth, int pixels,
                 std::vector<double>& sum)
{
  Corner b = second, c = third;
  std::int64_t area = edgeFunction(a, b, c.column, c.row);
  if (area == 0)
    return;
  // Rows increase downwards, so an outward oriented triangle is clockwise on the screen where the ray enters.
  const double sign = area > 0 ? -1.0 : 1.0;
  if (area < 0)
  {
    std::swap(b, c);
    area = -area;
  }
  const int row0 = firstPixel(std::min({a.row, b.row, c.row}));
  const int row1 = lastPixel(std::max({a.row, b.row, c.row}), pixels);
  const int column0 = firstPixel(std::min({a.column, b.column, c.column}));
  const int column1 = lastPixel(std::max({a.column, b.column, c.column}), pixels);
  const std::int64_t bias_a = edgeBias(b, c), bias_b = edgeBias(c, a), bias_c = edgeBias(a, b);
  const std::int64_t step_a = (b.row - c.row) * kSubpixels;
  const std::int64_t step_b = (c.row - a.row) * kSubpixels;
  const std::int64_t step_c = (a.row - b.row) * kSubpixels;
  const double inverse_area = 1.0 / static_cast<double>(area);
  for (int row = row0; row <= row1; ++row)
  {
    const std::int64_t x = column0 * kSubpixels, y = row * kSubpixels;
    std::int64_t wa = edgeFunction(b, c, x, y), wb = edgeFunction(c, a, x, y), wc = edgeFunction(a, b, x, y);
    double* pixel = sum.data() + static_cast<std::ptrdiff_t>(row) * pixels + column0;
    for (int column = column0; column <= column1; ++column, ++pixel, wa += step_a, wb += step_b, wc += step_c)
    {
      if (((wa - bias_a) | (wb - bias_b) | (wc - bias_c)) < 0)
        continue;
      // The inverse depth of a plane is affine in image coordinates.
      const double inverse_depth =
          (static_cast<double>(wa) * a.inverse_depth + static_cast<double>(wb) * b.inverse_depth +
           static_cast<double>(wc) * c.inverse_depth) *
          inverse_area;
      *pixel += sign * std::min(1.0 / inverse_depth, detector_depth);
    }
  }
}

void depthsToLengths(const XRayGeometry& geometry, std::vector<double>& sum)
{
  const int n = geometry.pixels();
  for (int row = 0; row < n; ++row)
    for (int column = 0; column < n; ++column)
    {
      double& length =
          sum[static_cast<std::size_t>(row) * static_cast<std::size_t>(n) + static_cast<std::size_t>(column)];
      if (length != 0.0)
        length = std::max(length, 0.0) * geometry.ray(column, row).norm();
    }
}

}  // namespace endovascular_sim::fluoroscopy
