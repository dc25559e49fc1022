#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <vector>

#include <Eigen/Core>

#include "segmentation/lumen/section.h"

namespace endovascular_sim::segmentation
{

/** Signed function of a lumen on a lattice, in blocks of 8³ points near and inside of it. */
class LatticeField
{
public:
  static constexpr int kEdge = 8;
  using Key = std::array<int, 3>;
  using Values = std::array<float, kEdge * kEdge * kEdge>;

  /** Field of the union of branches.
   *  @param blend range of the smooth minimum, in radii of the smaller branch */
  LatticeField(const std::vector<LumenBranch>& branches, double spacing, double blend, int threads);

  /** Field of values on a grid, i fastest, with the first one at the origin and a spacing of 1. The outermost values
   * are positive. */
  LatticeField(const std::vector<float>& values, const Eigen::Vector3i& size);

  double spacing() const { return spacing_; }
  const std::map<Key, Values>& blocks() const { return blocks_; }

  /** Value of points without a block [m]. */
  static constexpr float kOutside = 1e-3F;

private:
  std::map<Key, Values> blocks_;
  double spacing_;
};

}  // namespace endovascular_sim::segmentation
