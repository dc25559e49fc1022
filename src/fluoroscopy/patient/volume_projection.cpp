#include "fluoroscopy/patient/volume_projection.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "common/error.h"
#include "fluoroscopy/patient/lattice_ray.h"

namespace endovascular_sim::fluoroscopy
{
namespace
{

/** Sums of steps times 65536. */
struct Sum
{
  std::uint64_t tissue = 0;
  std::uint64_t bone = 0;
};

/** Strides of a lattice whose first axis is the sampling axis. */
struct Layout
{
  std::array<int, 3> axis{};
  std::array<std::ptrdiff_t, 3> stride{};
};

Layout layoutFor(int main_axis, const std::array<std::ptrdiff_t, 3>& stride)
{
  Layout layout;
  for (int i = 0; i < 3; ++i)
  {
    layout.axis[static_cast<std::size_t>(i)] = (main_axis + i) % 3;
    layout.stride[static_cast<std::size_t>(i)] = stride[static_cast<std::size_t>((main_axis + i) % 3)];
  }
  return layout;
}

/** Both components of a voxel in the halves of a word. */
std::uint64_t split(std::uint16_t voxel)
{
  return (voxel & 0xffU) | static_cast<std::uint64_t>(voxel >> 8) << 32;
}

/** Bilinear interpolation in a lattice plane, in steps times 65536.
 *  @param u, v position in the plane [2⁻³² voxel] */
std::uint64_t sample(const std::uint16_t* plane, std::ptrdiff_t stride_u, std::ptrdiff_t stride_v, std::int64_t u,
                     std::int64_t v)
{
  const std::uint16_t* corner = plane + (u >> 32) * stride_u + (v >> 32) * stride_v;
  const auto fu = static_cast<std::uint64_t>(u >> 24 & 0xff), fv = static_cast<std::uint64_t>(v >> 24 & 0xff);
  const std::uint64_t near = split(corner[0]) * (256 - fu) + split(corner[stride_u]) * fu;
  const std::uint64_t far = split(corner[stride_v]) * (256 - fu) + split(corner[stride_u + stride_v]) * fu;
  return near * (256 - fv) + far * fv;
}

/** Sum over the lattice planes [first, last] that a ray meets; u and v are its position in the first one. */
Sum sumOfPlanes(const std::uint16_t* voxels, const Layout& layout, std::int64_t first, std::int64_t last,
                std::int64_t u, std::int64_t v, std::int64_t du, std::int64_t dv)
{
  Sum sum;
  const std::uint16_t* plane = voxels + first * layout.stride[0];
  while (first <= last)
  {
    // 2⁸ samples of at most 255·2¹⁶ fit into 32 bits.
    const std::int64_t end = std::min(first + 255, last);
    std::uint64_t both = 0;
    for (; first <= end; ++first, plane += layout.stride[0], u += du, v += dv)
      both += sample(plane, layout.stride[1], layout.stride[2], u, v);
    sum.tissue += both & 0xffffffffU;
    sum.bone += both >> 32;
  }
  return sum;
}

/** Integrals of tissue and bone steps along the main axis, times 65536 [voxel]. */
std::pair<double, double> integrate(const std::uint16_t* voxels, const Eigen::Vector3i& size, const Layout& layout,
                                    const LatticeRay& ray)
{
  const int main = layout.axis[0];
  const double slope = ray.direction[main];
  double from = ray.origin[main] + ray.begin * slope, to = ray.origin[main] + ray.end * slope;
  if (from > to)
    std::swap(from, to);
  auto first = static_cast<std::int64_t>(std::ceil(from)), last = static_cast<std::int64_t>(std::floor(to));
  const bool between = first > last;  // two planes enclose the part
  if (between)
    first = last = static_cast<std::int64_t>(std::floor(0.5 * (from + to) + 0.5));
  const auto at = [&](double plane, std::size_t axis)
  {
    const int a = layout.axis[axis];
    return fixedPoint(std::clamp(ray.at(plane, a), 0.0, size[a] - 1 - kInsideLattice));
  };
  const auto value = [&](std::int64_t plane)
  {
    return sample(voxels + plane * layout.stride[0], layout.stride[1], layout.stride[2],
                  at(static_cast<double>(plane), 1), at(static_cast<double>(plane), 2));
  };
  const std::uint64_t head = value(first), tail = value(last);
  const auto weighted = [](double weight, std::uint64_t both)
  {
    return std::pair<double, double>(weight * static_cast<double>(both & 0xffffffffU),
                                     weight * static_cast<double>(both >> 32));
  };
  if (between)
    return weighted(to - from, head);
  const auto a = weighted(static_cast<double>(first) - from - 0.5, head);
  const auto b = weighted(to - static_cast<double>(last) - 0.5, tail);
  const std::int64_t u = at(static_cast<double>(first), 1), v = at(static_cast<double>(first), 2);
  const std::int64_t planes = std::max<std::int64_t>(last - first, 1);
  const std::int64_t du = (at(static_cast<double>(last), 1) - u) / planes,
                     dv = (at(static_cast<double>(last), 2) - v) / planes;
  const Sum sum = sumOfPlanes(voxels, layout, first, last, u, v, du, dv);
  return {static_cast<double>(sum.tissue) + a.first + b.first, static_cast<double>(sum.bone) + a.second + b.second};
}

/** Box of all voxels but those of air, widened by one voxel [voxel]. */
Eigen::AlignedBox3d occupiedBox(const patient::DensityVolume& volume)
{
  const Eigen::Vector3i size = volume.grid().size;
  Eigen::AlignedBox3d box;
  const std::uint16_t* voxel = volume.voxels().data();
  for (int z = 0; z < size.z(); ++z)
    for (int y = 0; y < size.y(); ++y, voxel += size.x())
    {
      const auto filled = [](std::uint16_t value) { return value != 0; };
      const std::uint16_t* first = std::find_if(voxel, voxel + size.x(), filled);
      if (first == voxel + size.x())
        continue;
      const std::uint16_t* last = voxel + size.x() - 1;
      while (*last == 0)
        --last;
      box.extend(Eigen::Vector3d(static_cast<double>(first - voxel), y, z));
      box.extend(Eigen::Vector3d(static_cast<double>(last - voxel), y, z));
    }
  if (box.isEmpty())
    return box;
  const Eigen::Vector3d last = (size.array() - 1).matrix().cast<double>();
  return {(box.min().array() - 1.0).max(0.0).matrix(), (box.max().array() + 1.0).matrix().cwiseMin(last)};
}

}  // namespace

VolumeProjection::VolumeProjection(const patient::DensityVolume& volume)
  : grid_(volume.grid()),
    stride_(stridesFor(volume.grid())),
    voxels_(volume.voxels().size()),
    occupied_(occupiedBox(volume))
{
  const std::uint16_t* voxel = volume.voxels().data();
  for (int z = 0; z < grid_.size.z(); ++z)
    for (int y = 0; y < grid_.size.y(); ++y)
    {
      std::uint16_t* target = voxels_.data() + y * stride_[1] + z * stride_[2];
      for (int x = 0; x < grid_.size.x(); ++x)
        target[x * stride_[0]] = *voxel++;
    }
}

ArealDensityImage VolumeProjection::project(const XRayGeometry& geometry, int samples) const
{
  ArealDensityImage image = emptyImage(samples);
  projectRows(geometry, 0, samples, image);
  return image;
}

void VolumeProjection::projectRows(const XRayGeometry& geometry, int begin, int end, ArealDensityImage& image) const
{
  if (occupied_.isEmpty())
    return;
  const LatticeRays rays(grid_, occupied_, geometry, image.samples);
  LatticeRay ray;
  for (int column = 0; column < image.samples; ++column)
    for (int row = begin; row < end; ++row)
    {
      const auto at =
          static_cast<std::size_t>(row) * static_cast<std::size_t>(image.samples) + static_cast<std::size_t>(column);
      image.tissue[at] = image.bone[at] = 0.0F;
      if (!rays.make(row, column, ray))
        continue;
      const Layout layout = layoutFor(ray.main, stride_);
      const auto [tissue, bone] = integrate(voxels_.data(), grid_.size, layout, ray);
      const double scale = ray.length / std::abs(ray.direction[ray.main]) / 65536.0;
      image.tissue[at] = static_cast<float>(patient::DensityVolume::kTissueStep * scale * tissue);
      image.bone[at] = static_cast<float>(patient::DensityVolume::kBoneStep * scale * bone);
    }
}

}  // namespace endovascular_sim::fluoroscopy
