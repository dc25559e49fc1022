#include "fluoroscopy/projection/signed_depth.h"

#include <algorithm>
#include <cmath>

#include "common/error.h"
#include "fluoroscopy/projection/covered_pixels.h"

namespace endovascular_sim::fluoroscopy
{
namespace
{

constexpr double kMaxCoordinate = 1 << 29;  // products of coordinate differences fit into 62 bits
constexpr double kNearest = 0.02;           // minimum depth of a vertex, as a fraction of SID

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

void addTriangle(const Corner& a, const Corner& b, const Corner& c, double detector_depth, int pixels,
                 std::vector<double>& sum)
{
  double* const first = sum.data();
  coveredPixels(a, b, c, pixels,
                [&](int row, int column, double inverse_depth, double sign) {
                  first[static_cast<std::ptrdiff_t>(row) * pixels + column] +=
                      sign * std::min(1.0 / inverse_depth, detector_depth);
                });
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
