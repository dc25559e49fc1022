#pragma once

#include <vector>

namespace endovascular_sim::phantom
{

/** Weights of a sampled Gaussian, of sum 1, from −radius to radius.
 *  @param deviation standard deviation [samples]; 0 gives the weight 1 alone */
std::vector<float> gaussianKernel(double deviation);

/** Convolves a slice with a kernel along its rows and another one along its columns. Values beyond the border are those
 *  of the border.
 *  @param slice values in row-major order */
void blurSlice(std::vector<float>& slice, int columns, int rows, const std::vector<float>& along_row,
               const std::vector<float>& along_column);

}  // namespace endovascular_sim::phantom
