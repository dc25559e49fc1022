#include "fluoroscopy/image/coarse_image.h"

#include <algorithm>
#include <cmath>

namespace endovascular_sim::fluoroscopy
{
namespace
{

constexpr int kBins = 32;
constexpr int kLanes = 8;  // partial sums, in a fixed order for every instruction set

/** Gaussian weights from −radius to radius, with the sum 1. */
std::vector<float> gaussian(double sigma, int& radius)
{
  radius = static_cast<int>(std::ceil(3.0 * sigma));
  std::vector<float> weights;
  double sum = 0.0;
  for (int k = -radius; k <= radius; ++k)
    sum += std::exp(-0.5 * k * k / (sigma * sigma));
  for (int k = -radius; k <= radius; ++k)
    weights.push_back(static_cast<float>(std::exp(-0.5 * k * k / (sigma * sigma)) / sum));
  return weights;
}

float sumOf(const float* values, int count)
{
  float sums[kLanes] = {};
  int k = 0;
  for (; k + kLanes <= count; k += kLanes)
    for (int lane = 0; lane < kLanes; ++lane)
      sums[lane] += values[k + lane];
  for (; k < count; ++k)
    sums[0] += values[k];
  float sum = 0.0F;
  for (const float part : sums)
    sum += part;
  return sum;
}

}  // namespace

CoarseImage::CoarseImage(int pixels)
  : pixels_(pixels), size_((pixels + kBins - 1) / kBins), bins_((pixels + size_ - 1) / size_)
{
  values_.assign(static_cast<std::size_t>(bins_) * static_cast<std::size_t>(bins_), 0.0F);
  for (int i = 0; i < pixels; ++i)
  {
    bin_of_.push_back(i / size_);
    const double x = (i + 0.5) / size_ - 0.5;  // in bins, 0 at the centre of the first one
    const int middle = static_cast<int>(std::lround(x));
    const double d = x - middle;
    const double weights[] = {0.5 * (0.5 - d) * (0.5 - d), 0.75 - d * d, 0.5 * (0.5 + d) * (0.5 + d)};
    Spline spline{};
    for (int k = 0; k < 3; ++k)
    {
      spline.bins[k] = std::clamp(middle + k - 1, 0, bins_ - 1);
      spline.weights[k] = static_cast<float>(weights[k]);
    }
    splines_.push_back(spline);
  }
}

void CoarseImage::average(const std::vector<float>& image)
{
  std::fill(values_.begin(), values_.end(), 0.0F);
  for (int row = 0; row < pixels_; ++row)
    for (int bin = 0; bin < bins_; ++bin)
      at(row / size_, bin) +=
          sumOf(image.data() + static_cast<std::ptrdiff_t>(row) * pixels_ + bin * size_, pixelsOf(bin));
  for (int row = 0; row < bins_; ++row)
    for (int column = 0; column < bins_; ++column)
      at(row, column) /= static_cast<float>(pixelsOf(row) * pixelsOf(column));
}

void CoarseImage::addPixel(std::size_t pixel, float change)
{
  const auto n = static_cast<std::size_t>(pixels_);
  addPixel(static_cast<int>(pixel / n), static_cast<int>(pixel % n), change);
}

void CoarseImage::blur(double sigma, bool keep_mean)
{
  int radius = 0;
  const std::vector<float> weights = gaussian(std::max(sigma / size_, 0.1), radius);
  std::vector<float> other(values_.size());
  for (const bool rows : {true, false})
  {
    for (int row = 0; row < bins_; ++row)
      for (int column = 0; column < bins_; ++column)
      {
        const int place = rows ? column : row;
        const int from = std::max(-radius, -place), to = std::min(radius, bins_ - 1 - place);
        float sum = 0.0F, total = 0.0F;
        for (int k = from; k <= to; ++k)
        {
          const float weight = weights[static_cast<std::size_t>(k + radius)];
          sum += weight * (rows ? at(row, column + k) : at(row + k, column));
          total += weight;
        }
        other[index(row, column)] = keep_mean ? sum / total : sum;
      }
    values_.swap(other);
  }
}

void CoarseImage::row(int row, float* values) const
{
  const Spline& vertical = splines_[static_cast<std::size_t>(row)];
  float line[kBins + 1];
  for (int bin = 0; bin < bins_; ++bin)
    line[bin] = vertical.weights[0] * at(vertical.bins[0], bin) + vertical.weights[1] * at(vertical.bins[1], bin) +
                vertical.weights[2] * at(vertical.bins[2], bin);
  for (int column = 0; column < pixels_; ++column)
  {
    const Spline& s = splines_[static_cast<std::size_t>(column)];
    values[column] = s.weights[0] * line[s.bins[0]] + s.weights[1] * line[s.bins[1]] + s.weights[2] * line[s.bins[2]];
  }
}

}  // namespace endovascular_sim::fluoroscopy
