#include "segmentation/lumen/scan.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace endovascular_sim::segmentation
{
namespace
{

/** Grid axis that is closest to each patient axis. */
Eigen::Vector3i closestAxes(const Eigen::Matrix3d& axes)
{
  static const int kOrders[6][3] = {{0, 1, 2}, {0, 2, 1}, {1, 0, 2}, {1, 2, 0}, {2, 0, 1}, {2, 1, 0}};
  double best = -1.0;
  Eigen::Vector3i order(0, 1, 2);
  for (const int* o : kOrders)
  {
    const double sum = std::abs(axes(0, o[0])) + std::abs(axes(1, o[1])) + std::abs(axes(2, o[2]));
    if (sum > best + 1e-9)
    {
      best = sum;
      order = {o[0], o[1], o[2]};
    }
  }
  return order;
}

}  // namespace

image::Volume canonical(image::Volume volume)
{
  const image::VolumeGrid& from = volume.grid;
  const Eigen::Vector3i order = closestAxes(from.axes);
  image::VolumeGrid to = from;
  Eigen::Vector3i first = Eigen::Vector3i::Zero();  // voxel of the old order that becomes the first one
  Eigen::Vector3i step = Eigen::Vector3i::Ones();
  for (int axis = 0; axis < 3; ++axis)
  {
    const int old = order[axis];
    step[axis] = from.axes(axis, old) < 0.0 ? -1 : 1;
    to.size[axis] = from.size[old];
    to.spacing[axis] = from.spacing[old];
    to.axes.col(axis) = step[axis] * from.axes.col(old);
    if (step[axis] < 0)
      first[old] = from.size[old] - 1;
  }
  if (order == Eigen::Vector3i(0, 1, 2) && step == Eigen::Vector3i::Ones())
    return volume;
  to.origin = from.position(first.cast<double>());
  std::vector<std::int16_t> stored(volume.stored.size());
  std::size_t n = 0;
  for (int k = 0; k < to.size.z(); ++k)
    for (int j = 0; j < to.size.y(); ++j)
      for (int i = 0; i < to.size.x(); ++i)
      {
        Eigen::Vector3i old = first;
        old[order[0]] += step[0] * i;
        old[order[1]] += step[1] * j;
        old[order[2]] += step[2] * k;
        stored[n++] = volume.stored[from.offset(old.x(), old.y(), old.z())];
      }
  volume.stored = std::move(stored);
  volume.grid = to;
  return volume;
}

Scan::Scan(image::Volume volume) : volume_(canonical(std::move(volume)))
{
  // NIfTI holds single precision, DICOM decimal numbers: equal grids of all formats have equal bits from here on.
  constexpr double kResolution = 1e-9;  // m
  for (int axis = 0; axis < 3; ++axis)
    volume_.grid.spacing[axis] = kResolution * std::round(volume_.grid.spacing[axis] / kResolution);
  inverse_spacing_ = volume_.grid.spacing.cwiseInverse();
}

double Scan::at(const Eigen::Vector3d& p) const
{
  int index[3];
  double f[3];
  for (int axis = 0; axis < 3; ++axis)
  {
    const double q = std::clamp(p[axis] * inverse_spacing_[axis], 0.0, volume_.grid.size[axis] - 1.0);
    index[axis] = std::min(static_cast<int>(q), volume_.grid.size[axis] - 2);
    f[axis] = q - index[axis];
  }
  const std::int16_t* s = &volume_.stored[volume_.grid.offset(index[0], index[1], index[2])];
  const std::size_t y = volume_.grid.offset(0, 1, 0);
  const std::size_t z = volume_.grid.offset(0, 0, 1);
  const auto mix = [](double a, double b, double t) { return a + (b - a) * t; };
  const double low = mix(mix(s[0], s[1], f[0]), mix(s[y], s[y + 1], f[0]), f[1]);
  const double high = mix(mix(s[z], s[z + 1], f[0]), mix(s[z + y], s[z + y + 1], f[0]), f[1]);
  return volume_.scale * mix(low, high, f[2]);
}

bool Scan::contains(const Eigen::Vector3d& p) const
{
  for (int axis = 0; axis < 3; ++axis)
    if (!(p[axis] >= 0.0 && p[axis] <= (volume_.grid.size[axis] - 1) * volume_.grid.spacing[axis]))
      return false;
  return true;
}

Eigen::Vector3i Scan::voxelOf(const Eigen::Vector3d& p) const
{
  Eigen::Vector3i voxel;
  for (int axis = 0; axis < 3; ++axis)
    voxel[axis] =
        static_cast<int>(std::lround(std::clamp(p[axis] * inverse_spacing_[axis], 0.0, volume_.grid.size[axis] - 1.0)));
  return voxel;
}

}  // namespace endovascular_sim::segmentation
