#pragma once

#include <vector>

#include <Eigen/Core>

#include "segmentation/lumen/scan.h"

namespace endovascular_sim::segmentation
{

/** Regions of an image that are wider than a vessel: the union of all balls of a given radius in which the image
 * exceeds a threshold (opening of the binary image by a ball), on a grid of about 0.9 mm. */
class WideRegions
{
public:
  /** No region. */
  WideRegions() = default;

  /** @param radius of the balls [m] */
  WideRegions(const Scan& scan, double threshold, double radius);

  /** @param p point of the grid frame [m] */
  bool contains(const Eigen::Vector3d& p) const;

private:
  Eigen::Vector3i size_ = Eigen::Vector3i::Zero();
  Eigen::Vector3d spacing_ = Eigen::Vector3d::Ones();
  Eigen::Vector3d offset_ = Eigen::Vector3d::Zero();
  std::vector<bool> wide_;
};

/** Exact squared Euclidean distances from the marked points of a grid (P. Felzenszwalb, D. Huttenlocher, "Distance
 *  transforms of sampled functions", 2012).
 *  @param squared 0 at marked points, large elsewhere, i fastest; receives the squared distances [m²] */
void squaredDistances(std::vector<float>& squared, const Eigen::Vector3i& size, const Eigen::Vector3d& spacing);

}  // namespace endovascular_sim::segmentation
