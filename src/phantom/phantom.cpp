#include "phantom/phantom.h"

#include <algorithm>
#include <cmath>
#include <deque>
#include <string>
#include <vector>

#include "common/error.h"
#include "common/numerics/counter_noise.h"
#include "common/numerics/parallel_for.h"
#include "phantom/gaussian_blur.h"
#include "phantom/tissue_painter.h"

namespace endovascular_sim::phantom
{
namespace
{

constexpr int kSlab = 8;  ///< slices that are computed together
constexpr double kLeast = -1024.0;
constexpr double kMost = 32767.0;

using Slice = std::vector<float>;

void requireRange(const char* name, double value, double least, double most, const std::string& unit)
{
  if (!(value >= least && value <= most))
    throw InputError("phantom", name,
                     "must be between " + std::to_string(least) + " and " + std::to_string(most) + unit);
}

/** Slices that have been computed, with the index of the first one. */
struct SliceQueue
{
  int first = 0;
  std::deque<Slice> slices;

  int end() const { return first + static_cast<int>(slices.size()); }
  const Slice& at(int k) const { return slices[static_cast<std::size_t>(k - first)]; }
  void dropBefore(int k)
  {
    while (first < k && !slices.empty())
    {
      slices.pop_front();
      ++first;
    }
  }
};

/** White noise of a slice, correlated within it. The numbers of a margin around the slice make its border like its
 *  middle. */
Slice noiseSlice(const PhantomSettings& settings, int k, const std::vector<float>& kernel)
{
  const int margin = static_cast<int>(kernel.size() / 2);
  const int columns = settings.grid.size.x() + 2 * margin;
  const int rows = settings.grid.size.y() + 2 * margin;
  const std::size_t count = static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows);
  std::vector<float> even((count + 1) / 2);
  std::vector<float> odd(even.size());
  const CounterNoise source(settings.seed, static_cast<std::uint64_t>(k + 1024));
  source.fill(0, static_cast<int>(even.size()), even.data(), odd.data());
  Slice wide(count);
  for (std::size_t p = 0; p < count; ++p)
    wide[p] = p % 2 == 0 ? even[p / 2] : odd[p / 2];
  blurSlice(wide, columns, rows, kernel, kernel);
  Slice slice;
  slice.reserve(settings.grid.offset(0, 0, 1));
  for (int j = 0; j < settings.grid.size.y(); ++j)
  {
    const auto begin = wide.begin() + static_cast<std::ptrdiff_t>(j + margin) * columns + margin;
    slice.insert(slice.end(), begin, begin + settings.grid.size.x());
  }
  return slice;
}

/** Generator of an image, slab by slab. */
class Synthesis
{
public:
  Synthesis(const SlicePainter& painter, const PhantomSettings& settings)
    : settings_(settings), threads_(threadCount(settings.threads)), painter_(painter)
  {
    for (int axis = 0; axis < 3; ++axis)
      spread_.push_back(gaussianKernel(settings.point_spread / settings.grid.spacing[axis]));
    grain_ = gaussianKernel(settings.noise_grain);
    double energy = 0.0;
    for (const float weight : grain_)
      energy += static_cast<double>(weight) * weight;
    noise_gain_ = settings.noise / std::pow(energy, 1.5);
    noise_.first = -static_cast<int>(grain_.size() / 2);
  }

  image::Volume run(const ProgressReport& progress)
  {
    image::Volume volume;
    volume.grid = settings_.grid;
    volume.modality = settings_.modality;
    volume.stored.resize(volume.grid.voxels());
    const int slices = volume.grid.size.z();
    for (int first = 0; first < slices; first += kSlab)
    {
      reportProgress(progress, "synthesizing the image", static_cast<double>(first) / slices);
      const int end = std::min(first + kSlab, slices);
      paintUntil(end + radius(spread_[2]));
      addNoiseUntil(end + radius(grain_));
      parallelFor(static_cast<std::size_t>(end - first), threads_,
                  [&](std::size_t k) { store(first + static_cast<int>(k), volume); });
      tissue_.dropBefore(end - radius(spread_[2]));
      noise_.dropBefore(end - radius(grain_));
    }
    return volume;
  }

private:
  static int radius(const std::vector<float>& kernel) { return static_cast<int>(kernel.size() / 2); }

  void paintUntil(int end)
  {
    end = std::min(end, settings_.grid.size.z());
    while (tissue_.end() < end)
    {
      const int first = tissue_.end();
      std::vector<Slice> slab(static_cast<std::size_t>(std::min(kSlab, settings_.grid.size.z() - first)));
      painter_(first, slab, threads_);
      parallelFor(slab.size(), threads_,
                  [&](std::size_t k)
                  { blurSlice(slab[k], settings_.grid.size.x(), settings_.grid.size.y(), spread_[0], spread_[1]); });
      for (Slice& slice : slab)
        tissue_.slices.push_back(std::move(slice));
    }
  }

  void addNoiseUntil(int end)
  {
    if (settings_.noise == 0.0)
      return;
    const int first = noise_.end();
    if (end <= first)
      return;
    std::vector<Slice> slab(static_cast<std::size_t>(end - first));
    parallelFor(slab.size(), threads_,
                [&](std::size_t k) { slab[k] = noiseSlice(settings_, first + static_cast<int>(k), grain_); });
    for (Slice& slice : slab)
      noise_.slices.push_back(std::move(slice));
  }

  /** Completes the convolutions along k, and rounds the values of a slice. */
  void store(int k, image::Volume& volume) const
  {
    Slice sum(settings_.grid.offset(0, 0, 1), 0.0F);
    const auto add = [&sum](const Slice& slice, float weight)
    {
      for (std::size_t p = 0; p < sum.size(); ++p)
        sum[p] += weight * slice[p];
    };
    for (int q = -radius(spread_[2]); q <= radius(spread_[2]); ++q)
      add(tissue_.at(std::clamp(k + q, 0, settings_.grid.size.z() - 1)),
          spread_[2][static_cast<std::size_t>(q + radius(spread_[2]))]);
    if (settings_.noise > 0.0)
      for (int q = -radius(grain_); q <= radius(grain_); ++q)
        add(noise_.at(k + q), static_cast<float>(noise_gain_) * grain_[static_cast<std::size_t>(q + radius(grain_))]);
    std::int16_t* out = &volume.stored[settings_.grid.offset(0, 0, k)];
    for (std::size_t p = 0; p < sum.size(); ++p)
      out[p] = static_cast<std::int16_t>(std::lround(std::clamp(static_cast<double>(sum[p]), kLeast, kMost)));
  }

  PhantomSettings settings_;
  int threads_;
  const SlicePainter& painter_;
  std::vector<std::vector<float>> spread_;  ///< kernels of the point spread along i, j and k
  std::vector<float> grain_;
  double noise_gain_ = 0.0;
  SliceQueue tissue_;  ///< slices with the point spread in their plane
  SliceQueue noise_;
};

}  // namespace

image::VolumeGrid gridOfBox(const Eigen::Vector3d& low, const Eigen::Vector3d& high, const Eigen::Vector3d& spacing)
{
  image::VolumeGrid grid;
  grid.spacing = spacing;
  grid.origin = low + 0.5 * spacing;
  for (int axis = 0; axis < 3; ++axis)
    grid.size[axis] = std::max(2, static_cast<int>(std::ceil((high[axis] - low[axis]) / spacing[axis] - 1e-9)));
  return grid;
}

image::Volume blurredImage(const SlicePainter& painter, const PhantomSettings& settings, const ProgressReport& progress)
{
  image::requireValid(settings.grid, "phantom");
  requireRange("point spread", 1e3 * settings.point_spread, 0.0, 10.0, " mm");
  requireRange("noise", settings.noise, 0.0, 1000.0, "");
  requireRange("noise grain", settings.noise_grain, 0.0, 5.0, " voxels");
  requireRange("wall thickness", 1e3 * settings.wall_thickness, 0.0, 5.0, " mm");
  return Synthesis(painter, settings).run(progress);
}

image::Volume makePhantom(const vessel::Anatomy& anatomy, const PhantomSettings& settings,
                          const ProgressReport& progress)
{
  image::requireValid(settings.grid, "phantom");
  const TissuePainter painter(anatomy, settings.grid, settings.modality, settings.wall_thickness);
  return blurredImage([&painter](int first, std::vector<Slice>& slices, int threads)
                      { painter.paint(first, slices, threads); },
                      settings, progress);
}

}  // namespace endovascular_sim::phantom
