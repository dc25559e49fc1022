#include "fluoroscopy/patient/moved_tissue.h"

#include <algorithm>
#include <cmath>

namespace endovascular_sim::fluoroscopy
{
namespace
{

constexpr double kLatticeSpacing = 6e-3;     // of the displacements [m]
constexpr double kSampleDistance = 2.6e-3;   // largest one of kFast along the main axis [m]
constexpr double kKnotDistance = 7.6e-3;     // between which displacements are linear [m]
constexpr double kScale = 1.0 / 16777216.0;  // of a sample
constexpr double kMargin = 4e-3;             // against the rounding of positions [voxel]
constexpr std::int64_t kRounding = std::int64_t{1} << 23;

/** Steps of soft tissue in which tissue fills bone: 8/5 · 1050/1920 = 7/8 step of tissue per step of bone. */
std::uint8_t filled(std::uint16_t voxel)
{
  return static_cast<std::uint8_t>(std::min(255, (voxel & 0xff) + (7 * (voxel >> 8) + 4) / 8));
}

/** Trilinear interpolation, in steps times 2²⁴. @param x, y, z position [2⁻³² voxel] */
std::uint32_t sample(const std::uint8_t* voxels, const std::array<std::ptrdiff_t, 3>& stride, std::int64_t x,
                     std::int64_t y, std::int64_t z)
{
  const std::uint8_t* corner = voxels + (x >> 32) * stride[0] + (y >> 32) * stride[1] + (z >> 32) * stride[2];
  const auto fx = static_cast<std::uint32_t>(x >> 24 & 0xff), fy = static_cast<std::uint32_t>(y >> 24 & 0xff),
             fz = static_cast<std::uint32_t>(z >> 24 & 0xff);
  const auto along = [&](const std::uint8_t* at) -> std::uint32_t { return at[0] * (256 - fz) + at[stride[2]] * fz; };
  const std::uint32_t near = along(corner) * (256 - fy) + along(corner + stride[1]) * fy;
  const std::uint32_t far = along(corner + stride[0]) * (256 - fy) + along(corner + stride[0] + stride[1]) * fy;
  return near * (256 - fx) + far * fx;
}

}  // namespace

MovedTissue::MovedTissue(const VolumeProjection& projection, const motion::HeartFrame& frame)
  : grid_(projection.grid()),
    occupied_(projection.occupied()),
    frame_(frame),
    at_rest_(motion::MotionMap(frame, {}, {}), 0.0),
    step_(std::max<std::int64_t>(1, static_cast<std::int64_t>(kSampleDistance / grid_.spacing.minCoeff()))),
    knot_(std::max<std::int64_t>(step_,
                                 static_cast<std::int64_t>(kKnotDistance / grid_.spacing.minCoeff()) / step_ * step_)),
    lattice_(at_rest_.box(), kLatticeSpacing)
{
  Eigen::AlignedBox3d box;  // of the places that move [voxel]
  for (int corner = 0; corner < 8; ++corner)
    box.extend(grid_.index(at_rest_.box().corner(static_cast<Eigen::AlignedBox3d::CornerType>(corner))));
  for (int axis = 0; axis < 3; ++axis)
  {
    const double most = grid_.size[axis] - 1.0;
    low_[axis] = static_cast<int>(std::clamp(std::floor(box.min()[axis]) - 1.0, 0.0, most - 1.0));
    size_[axis] =
        static_cast<int>(std::clamp(std::ceil(box.max()[axis]) + 1.0, low_[axis] + 1.0, most)) - low_[axis] + 1;
  }
  image::VolumeGrid cropped = grid_;
  cropped.size = size_;
  stride_ = stridesFor(cropped);
  filled_.resize(cropped.voxels());
  const auto& whole = projection.strides();
  for (int x = 0; x < size_.x(); ++x)
    for (int y = 0; y < size_.y(); ++y)
      for (int z = 0; z < size_.z(); ++z)
        filled_[static_cast<std::size_t>(x * stride_[0] + y * stride_[1] + z * stride_[2])] =
            filled(projection.voxels()[static_cast<std::size_t>((x + low_.x()) * whole[0] + (y + low_.y()) * whole[1] +
                                                                (z + low_.z()) * whole[2])]);
}

/** Sum over @p count + 1 equidistant samples from @p from to @p to without the last one, in steps. */
double MovedTissue::sumOfSegment(const Position& from, const Position& to, int count) const
{
  std::int64_t at[3], step[3];
  for (int axis = 0; axis < 3; ++axis)
  {
    const double most = size_[axis] - 1.0 - kMargin;
    const double begin = std::clamp(from[static_cast<std::size_t>(axis)] - low_[axis], 0.0, most);
    const double end = std::clamp(to[static_cast<std::size_t>(axis)] - low_[axis], 0.0, most);
    at[axis] = fixedPoint(begin) + kRounding;
    step[axis] = (fixedPoint(end) + kRounding - at[axis]) / count;
  }
  std::uint64_t sum = 0;
  for (int k = 0; k < count; ++k, at[0] += step[0], at[1] += step[1], at[2] += step[2])
    sum += sample(filled_.data(), stride_, at[0], at[1], at[2]);
  return kScale * static_cast<double>(sum);
}

template <typename Visit>
void MovedTissue::forEachRay(const XRayGeometry& geometry, int samples, std::int64_t step, const Visit& visit) const
{
  if (occupied_.isEmpty())
    return;
  const LatticeRays rays(grid_, occupied_, geometry, samples);
  LatticeRay ray;
  for (int column = 0; column < samples; ++column)
    for (int row = 0; row < samples; ++row)
    {
      const Eigen::Vector3d direction = rays.patientDirection(row, column);
      double begin = 0.0, end = 0.0;
      if (!rays.make(row, column, ray) || !at_rest_.clip(geometry.source(), direction, begin, end))
        continue;
      const double slope = ray.direction[ray.main];
      double from = ray.origin[ray.main] + std::max(begin, ray.begin) * slope;
      double to = ray.origin[ray.main] + std::min(end, ray.end) * slope;
      if (from > to)
        std::swap(from, to);
      // Planes are counted from the lattice's first one, so that the samples are fixed in the volume.
      const Part part{static_cast<std::int64_t>(std::ceil(from / static_cast<double>(step))) * step,
                      static_cast<std::int64_t>(std::floor(to / static_cast<double>(step))) * step, step};
      if (std::max(begin, ray.begin) < std::min(end, ray.end) && !part.empty())
        visit(static_cast<std::size_t>(row) * static_cast<std::size_t>(samples) + static_cast<std::size_t>(column), ray,
              part, direction);
    }
}

double MovedTissue::sumAtRest(const LatticeRay& ray, const Part& part) const
{
  const auto place = [&](std::int64_t plane)
  {
    const auto p = static_cast<double>(plane);
    return Position{ray.at(p, 0), ray.at(p, 1), ray.at(p, 2)};
  };
  const Position last = place(part.last);
  double sum = sumOfSegment(last, last, 1);
  if (part.last > part.first)
    sum += sumOfSegment(place(part.first), last, part.samples() - 1);
  return sum;
}

double MovedTissue::sumMoved(const LatticeRay& ray, const Part& part, const BodyMotion& motion)
{
  points_.clear();
  for (std::int64_t plane = part.first; plane <= part.last; plane += part.step)
  {
    const auto p = static_cast<double>(plane);
    points_.push_back(grid_.position({ray.at(p, 0), ray.at(p, 1), ray.at(p, 2)}));
  }
  motion.pullBack(points_, rest_);
  double sum = 0.0;
  for (const Eigen::Vector3d& point : rest_)
  {
    const Eigen::Vector3d index = grid_.index(point);
    const Position place{index.x(), index.y(), index.z()};
    sum += sumOfSegment(place, place, 1);
  }
  return sum;
}

double MovedTissue::sumMovedFast(const LatticeRay& ray, const Part& part, const Eigen::Vector3d& source,
                                 const Eigen::Vector3d& direction) const
{
  const auto place = [&](std::int64_t plane)
  {
    const auto p = static_cast<double>(plane);
    const double depth = (p - ray.origin[ray.main]) / ray.direction[ray.main];
    const Eigen::Vector3f moved = lattice_.at(source + depth * direction);
    return Position{ray.origin[0] + depth * ray.direction[0] + static_cast<double>(moved[0]),
                    ray.origin[1] + depth * ray.direction[1] + static_cast<double>(moved[1]),
                    ray.origin[2] + depth * ray.direction[2] + static_cast<double>(moved[2])};
  };
  double sum = 0.0;
  Position from = place(part.first);
  for (std::int64_t plane = part.first; plane < part.last;)
  {
    const std::int64_t next = std::min(plane + knot_, part.last);
    const Position to = place(next);
    sum += sumOfSegment(from, to, static_cast<int>((next - plane) / part.step));
    from = to;
    plane = next;
  }
  return sum + sumOfSegment(from, from, 1);
}

void MovedTissue::sumResting(const XRayGeometry& geometry, int samples, std::int64_t step)
{
  const std::size_t size = static_cast<std::size_t>(samples) * static_cast<std::size_t>(samples);
  if (resting_pose_ && *resting_pose_ == geometry.pose() && resting_.size() == size && resting_step_ == step)
    return;
  resting_.assign(size, 0.0);
  forEachRay(geometry, samples, step,
             [&](std::size_t at, const LatticeRay& ray, const Part& part, const Eigen::Vector3d&)
             { resting_[at] = sumAtRest(ray, part); });
  resting_pose_ = geometry.pose();
  resting_step_ = step;
}

std::vector<float> MovedTissue::change(const XRayGeometry& geometry, int samples, const BodyMotion& motion,
                                       MotionSampling sampling)
{
  const bool fast = sampling == MotionSampling::kFast;
  const std::int64_t step = fast ? step_ : 1;
  sumResting(geometry, samples, step);
  std::vector<float> change(resting_.size(), 0.0F);
  if (fast)
    lattice_.fill(motion, grid_.spacing.cwiseInverse().asDiagonal() * grid_.axes.transpose());
  forEachRay(geometry, samples, step,
             [&](std::size_t at, const LatticeRay& ray, const Part& part, const Eigen::Vector3d& direction)
             {
               const double sum =
                   fast ? sumMovedFast(ray, part, geometry.source(), direction) : sumMoved(ray, part, motion);
               const double length = static_cast<double>(step) * ray.length / std::abs(ray.direction[ray.main]);
               change[at] = static_cast<float>(patient::DensityVolume::kTissueStep * length * (sum - resting_[at]));
             });
  return change;
}

}  // namespace endovascular_sim::fluoroscopy
