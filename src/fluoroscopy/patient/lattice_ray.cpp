#include "fluoroscopy/patient/lattice_ray.h"

#include <algorithm>
#include <cmath>

namespace endovascular_sim::fluoroscopy
{
namespace
{

constexpr double kMaxInclination = 0.5;  // smallest share of the sampling axis in a ray's direction (cosine)

}  // namespace

bool LatticeRay::clip(const Eigen::AlignedBox3d& box)
{
  for (int axis = 0; axis < 3; ++axis)
  {
    const double from = box.min()[axis] - origin[axis], to = box.max()[axis] - origin[axis];
    const double d = direction[axis];
    if (d == 0.0)
    {
      if (from > 0.0 || to < 0.0)
        return false;
      continue;
    }
    begin = std::max(begin, std::min(from / d, to / d));
    end = std::min(end, std::max(from / d, to / d));
  }
  return begin < end;
}

LatticeRays::LatticeRays(const image::VolumeGrid& grid, const Eigen::AlignedBox3d& box, const XRayGeometry& geometry,
                         int samples)
  : grid_(grid),
    box_(box),
    geometry_(geometry),
    axes_(geometry.axes()),
    from_optical_(grid.axes.transpose() * geometry.axes()),
    origin_(grid.index(geometry.source())),
    central_(largestAxis(from_optical_.col(2).cwiseQuotient(grid.spacing))),
    pixels_per_sample_(static_cast<double>(geometry.pixels()) / samples)
{
}

Eigen::Vector3d LatticeRays::optical(int row, int column) const
{
  return geometry_.ray((column + 0.5) * pixels_per_sample_ - 0.5, (row + 0.5) * pixels_per_sample_ - 0.5);
}

bool LatticeRays::make(int row, int column, LatticeRay& ray) const
{
  const Eigen::Vector3d direction = optical(row, column);
  ray = {origin_,
         (from_optical_ * direction).cwiseQuotient(grid_.spacing),
         0.0,
         geometry_.pose().source_to_detector,
         direction.norm(),
         central_};
  if (!ray.clip(box_))
    return false;
  if (std::abs(ray.direction[central_]) < kMaxInclination * ray.direction.norm())
    ray.main = largestAxis(ray.direction);
  return true;
}

int largestAxis(const Eigen::Vector3d& direction)
{
  Eigen::Index axis = 0;
  direction.cwiseAbs().maxCoeff(&axis);
  return static_cast<int>(axis);
}

std::int64_t fixedPoint(double value)
{
  return std::llround(value * 4294967296.0);
}

std::array<std::ptrdiff_t, 3> stridesFor(const image::VolumeGrid& grid)
{
  const int fastest = largestAxis(grid.axes.row(2).transpose());
  const int second = (fastest + 1) % 3, third = (fastest + 2) % 3;
  std::array<std::ptrdiff_t, 3> stride{};
  stride[static_cast<std::size_t>(fastest)] = 1;
  stride[static_cast<std::size_t>(second)] = grid.size[fastest];
  stride[static_cast<std::size_t>(third)] = static_cast<std::ptrdiff_t>(grid.size[fastest]) * grid.size[second];
  return stride;
}

}  // namespace endovascular_sim::fluoroscopy
