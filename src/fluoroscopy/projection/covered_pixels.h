#pragma once

#include <algorithm>
#include <cstdint>
#include <utility>

#include "fluoroscopy/projection/signed_depth.h"

namespace endovascular_sim::fluoroscopy
{

constexpr int kSubpixelBits = 12;
constexpr std::int64_t kSubpixels = std::int64_t{1} << kSubpixelBits;

/** Edge function: twice the signed area of the triangle (a, b, (column, row)); positive if clockwise on the screen. */
inline std::int64_t edgeFunction(const Corner& a, const Corner& b, std::int64_t column, std::int64_t row)
{
  return (b.column - a.column) * (row - a.row) - (b.row - a.row) * (column - a.column);
}

/** Fill-rule bias: 0 if samples exactly on the edge a → b belong to the triangle, else 1. It is equivalent to a shift
 *  of all samples by (ε, ε²), after which no sample lies on an edge. */
inline std::int64_t edgeBias(const Corner& a, const Corner& b)
{
  const bool inside = b.row < a.row || (b.row == a.row && b.column > a.column);
  return inside ? 0 : 1;
}

inline int firstPixel(std::int64_t subpixel)
{
  return static_cast<int>((std::max<std::int64_t>(subpixel, 0) + kSubpixels - 1) >> kSubpixelBits);
}

inline int lastPixel(std::int64_t subpixel, int pixels)
{
  return subpixel < 0 ? -1 : static_cast<int>(std::min<std::int64_t>(subpixel >> kSubpixelBits, pixels - 1));
}

/** Visits every pixel whose central ray intersects a triangle.
 *  @param visit called with row, column, the inverse depth there [1/m], and the sign: + where rays leave the mesh, −
 *         where they enter it */
template <typename Visit>
void coveredPixels(const Corner& a, const Corner& second, const Corner& third, int pixels, const Visit& visit)
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
  if (row0 > row1 || column0 > column1)
    return;  // between the rays, as most triangles of a fine mesh, or outside of the image
  const std::int64_t bias_a = edgeBias(b, c), bias_b = edgeBias(c, a), bias_c = edgeBias(a, b);
  const std::int64_t step_a = (b.row - c.row) * kSubpixels;
  const std::int64_t step_b = (c.row - a.row) * kSubpixels;
  const std::int64_t step_c = (a.row - b.row) * kSubpixels;
  const double inverse_area = 1.0 / static_cast<double>(area);
  for (int row = row0; row <= row1; ++row)
  {
    const std::int64_t x = column0 * kSubpixels, y = row * kSubpixels;
    std::int64_t wa = edgeFunction(b, c, x, y), wb = edgeFunction(c, a, x, y), wc = edgeFunction(a, b, x, y);
    for (int column = column0; column <= column1; ++column, wa += step_a, wb += step_b, wc += step_c)
    {
      if (((wa - bias_a) | (wb - bias_b) | (wc - bias_c)) < 0)
        continue;
      // The inverse depth of a plane is affine in image coordinates.
      const double inverse_depth =
          (static_cast<double>(wa) * a.inverse_depth + static_cast<double>(wb) * b.inverse_depth +
           static_cast<double>(wc) * c.inverse_depth) *
          inverse_area;
      visit(row, column, inverse_depth, sign);
    }
  }
}

}  // namespace endovascular_sim::fluoroscopy
