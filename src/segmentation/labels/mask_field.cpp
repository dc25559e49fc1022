#include "segmentation/labels/mask_field.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace endovascular_sim::segmentation
{
namespace
{

constexpr double kSmoothing = 1.0;  ///< standard deviation of the filter [voxels]
constexpr double kWindow = 2.5;     ///< standard deviation of the windows of equal volume [voxels]
constexpr int kRounds = 3;
constexpr float kLargestMove = 0.5F;  ///< [voxels]
constexpr float kLeast = 0.02F;       ///< magnitude of a value whose sign is imposed [voxels]

/** Separable Gaussian filter in voxels; values beyond the grid are those of its border. */
class Gaussian
{
public:
  explicit Gaussian(double deviation)
  {
    const int reach = static_cast<int>(std::ceil(3.5 * deviation));
    double sum = 0.0;
    for (int k = -reach; k <= reach; ++k)
      sum += std::exp(-0.5 * k * k / (deviation * deviation));
    for (int k = -reach; k <= reach; ++k)
      weights_.push_back(static_cast<float>(std::exp(-0.5 * k * k / (deviation * deviation)) / sum));
  }

  std::vector<float> operator()(const std::vector<float>& values, const Eigen::Vector3i& size) const
  {
    const auto nx = static_cast<std::size_t>(size.x());
    const auto ny = static_cast<std::size_t>(size.y());
    const auto nz = static_cast<std::size_t>(size.z());
    std::vector<float> a(values.size());
    std::vector<float> b(values.size());
    for (std::size_t row = 0; row < ny * nz; ++row)
      alongRow(&values[row * nx], &a[row * nx], nx);
    for (std::size_t k = 0; k < nz; ++k)
      acrossRows(&a[k * ny * nx], &b[k * ny * nx], ny, nx);
    acrossRows(b.data(), a.data(), nz, ny * nx);
    return a;
  }

private:
  std::size_t clamped(std::size_t at, std::size_t tap, std::size_t n) const
  {
    const auto place = static_cast<std::ptrdiff_t>(at + tap) - static_cast<std::ptrdiff_t>(weights_.size() / 2);
    return static_cast<std::size_t>(std::clamp<std::ptrdiff_t>(place, 0, static_cast<std::ptrdiff_t>(n) - 1));
  }

  void alongRow(const float* from, float* to, std::size_t n) const
  {
    for (std::size_t i = 0; i < n; ++i)
    {
      float sum = 0.0F;
      for (std::size_t tap = 0; tap < weights_.size(); ++tap)
        sum += weights_[tap] * from[clamped(i, tap, n)];
      to[i] = sum;
    }
  }

  /** Filters n rows of a length across their direction. */
  void acrossRows(const float* from, float* to, std::size_t n, std::size_t length) const
  {
    for (std::size_t i = 0; i < n; ++i)
    {
      float* target = to + i * length;
      std::fill(target, target + length, 0.0F);
      for (std::size_t tap = 0; tap < weights_.size(); ++tap)
      {
        const float weight = weights_[tap];
        const float* source = from + clamped(i, tap, n) * length;
        for (std::size_t k = 0; k < length; ++k)
          target[k] += weight * source[k];
      }
    }
  }

  std::vector<float> weights_;
};

/** Moves the surface by the local deficit of its volume. */
void restoreVolume(const std::vector<float>& indicator, const Eigen::Vector3i& size, std::vector<float>& field)
{
  const Gaussian window(kWindow);
  std::vector<float> deficit(field.size());
  std::vector<float> band(field.size());
  for (std::size_t n = 0; n < field.size(); ++n)
  {
    deficit[n] = indicator[n] - std::clamp(0.5F - field[n], 0.0F, 1.0F);
    band[n] = std::abs(field[n]) < 0.5F ? 1.0F : 0.0F;  // as many voxels as the surface has area
  }
  deficit = window(deficit, size);
  band = window(band, size);
  for (std::size_t n = 0; n < field.size(); ++n)
    field[n] -= std::clamp(deficit[n] / (band[n] + 1e-6F), -kLargestMove, kLargestMove);
}

}  // namespace

std::vector<float> smoothField(const VoxelMask& mask)
{
  const std::vector<float> indicator(mask.inside.begin(), mask.inside.end());
  const Gaussian filter(kSmoothing);
  std::vector<float> field = filter(indicator, mask.size);
  const std::vector<float> twice = filter(field, mask.size);
  // Slope of the filtered edge of a half-space [1/voxel].
  const auto slope = static_cast<float>((2.0 - std::sqrt(0.5)) / (kSmoothing * std::sqrt(2.0 * M_PI)));
  for (std::size_t n = 0; n < field.size(); ++n)
    field[n] = (0.5F - (2.0F * field[n] - twice[n])) / slope;
  for (int round = 0; round < kRounds; ++round)
    restoreVolume(indicator, mask.size, field);
  return field;
}

void imposeSigns(const VoxelMask& mask, std::vector<float>& field)
{
  for (std::size_t n = 0; n < field.size(); ++n)
    if (mask.inside[n] != 0)
      field[n] = std::min(field[n], -kLeast);
    else
      field[n] = std::max(field[n], kLeast);
}

}  // namespace endovascular_sim::segmentation
