#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

namespace endovascular_sim::fluoroscopy
{

/** Image of square bins, about 32 per side, for quantities that vary slowly. */
class CoarseImage
{
public:
  /** @param pixels pixels per side of the full image */
  explicit CoarseImage(int pixels);

  int bins() const { return bins_; }  ///< per side
  int binPixels() const
  {
    return size_;
  }  ///< pixels per side of a bin; bins at the right and lower edge may be smaller
  float& at(int row, int column) { return values_[index(row, column)]; }
  float at(int row, int column) const { return values_[index(row, column)]; }
  std::vector<float>& values() { return values_; }

  /** Sets each bin to the mean of a full image. */
  void average(const std::vector<float>& image);

  /** Adds a change of one pixel of the full image to the mean of its bin. */
  void addPixel(std::size_t pixel, float change);

  /** The same by row and column. */
  void addPixel(int row, int column, float change)
  {
    const int r = bin_of_[static_cast<std::size_t>(row)], c = bin_of_[static_cast<std::size_t>(column)];
    at(r, c) += change / static_cast<float>(pixelsOf(r) * pixelsOf(c));
  }

  /** Convolves with a normalised Gaussian; bins outside of the image are zero.
   *  @param sigma standard deviation [pixel]
   *  @param keep_mean true: the weights are normalised at the edges too */
  void blur(double sigma, bool keep_mean);

  /** Interpolates a row of the full image by quadratic B-splines, whose slope is continuous. */
  void row(int row, float* values) const;

private:
  std::size_t index(int row, int column) const
  {
    return static_cast<std::size_t>(row) * static_cast<std::size_t>(bins_) + static_cast<std::size_t>(column);
  }
  int pixelsOf(int bin) const { return std::min(size_, pixels_ - bin * size_); }

  /** Bins and weights of a pixel. */
  struct Spline
  {
    int bins[3];
    float weights[3];
  };

  int pixels_, size_, bins_;
  std::vector<float> values_;
  std::vector<int> bin_of_;      ///< per row or column of the full image
  std::vector<Spline> splines_;  ///< per row or column of the full image
};

}  // namespace endovascular_sim::fluoroscopy
