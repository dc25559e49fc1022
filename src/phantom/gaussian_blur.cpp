#include "phantom/gaussian_blur.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace endovascular_sim::phantom
{

std::vector<float> gaussianKernel(double deviation)
{
  if (deviation < 0.05)
    return {1.0F};
  const int radius = std::max(1, static_cast<int>(std::ceil(3.5 * deviation)));
  std::vector<double> weights;
  double sum = 0.0;
  for (int k = -radius; k <= radius; ++k)
  {
    weights.push_back(std::exp(-0.5 * k * k / (deviation * deviation)));
    sum += weights.back();
  }
  std::vector<float> kernel;
  kernel.reserve(weights.size());
  for (const double weight : weights)
    kernel.push_back(static_cast<float>(weight / sum));
  return kernel;
}

void blurSlice(std::vector<float>& slice, int columns, int rows, const std::vector<float>& along_row,
               const std::vector<float>& along_column)
{
  const int row_radius = static_cast<int>(along_row.size() / 2);
  const int column_radius = static_cast<int>(along_column.size() / 2);
  const auto width = static_cast<std::size_t>(columns);
  std::vector<float> padded(width + along_row.size());
  for (int j = 0; j < rows; ++j)
  {
    float* row = &slice[static_cast<std::size_t>(j) * width];
    for (int i = -row_radius; i < columns + row_radius; ++i)
      padded[static_cast<std::size_t>(i + row_radius)] = row[std::clamp(i, 0, columns - 1)];
    std::fill(row, row + columns, 0.0F);
    for (std::size_t k = 0; k < along_row.size(); ++k)
      for (std::size_t i = 0; i < width; ++i)
        row[i] += along_row[k] * padded[i + k];
  }
  const std::vector<float> source = slice;
  std::fill(slice.begin(), slice.end(), 0.0F);
  for (int j = 0; j < rows; ++j)
    for (std::size_t k = 0; k < along_column.size(); ++k)
    {
      const int from = std::clamp(j + static_cast<int>(k) - column_radius, 0, rows - 1);
      const float* in = &source[static_cast<std::size_t>(from) * width];
      float* out = &slice[static_cast<std::size_t>(j) * width];
      for (std::size_t i = 0; i < width; ++i)
        out[i] += along_column[k] * in[i];
    }
}

}  // namespace endovascular_sim::phantom
