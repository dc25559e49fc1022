#pragma once

#include <cstdint>
#include <vector>

#include <Eigen/Core>

namespace endovascular_sim::fluoroscopy
{

constexpr float kSmallestCount = 0.5F;  ///< of which a logarithm is taken

/** Logarithmic subtraction s = ln I − ln M: the negative optical depth of what the mask does not contain, e.g. of
 *  iodine. Scatter and beam hardening make s smaller than that depth.
 *
 *  @param counts I of the detector, row-major
 *  @param mask logarithms ln M, as many
 *  @param pixels per side
 *  @param shift of the mask, towards larger columns and rows [pixel]; fractions are interpolated by a
 *         cubic convolution (Keys 1981, a = −½), beyond the edge the mask's edge is repeated */
std::vector<float> logDifference(const std::vector<std::uint16_t>& counts, const std::vector<float>& mask, int pixels,
                                 const Eigen::Vector2d& shift);

/** Image moved by a shift, as the mask of logDifference(). A shift of zero returns its bits. */
std::vector<float> shifted(const std::vector<float>& image, int pixels, const Eigen::Vector2d& shift);

}  // namespace endovascular_sim::fluoroscopy
