#pragma once

#include <vector>

#include <Eigen/Core>

#include "intervention/shaft_line.h"

namespace endovascular_sim
{
class Archive;
}

namespace endovascular_sim::simulation
{

/** Place in the vessel of a balloon that presses on it. The wall holds an inflated balloon: the place follows the shaft
 *  with at most 0.5 mm/s (assumed), so that the heart, which tugs at the shaft, does not push the wall to and fro. */
class HeldShaft
{
public:
  /** Follows the shaft for a step.
   *  @param shaft in the vessel at rest
   *  @param begin, end of the balloon, distances from the tip [m]
   *  @param time_step [s]
   *  @return the held shaft; at the first call after release() that of the argument */
  intervention::ShaftLine follow(const intervention::ShaftLine& shaft, double begin, double end, double time_step);

  /** Lets the shaft go, when the balloon is empty. */
  void release() { points_.clear(); }

  void archive(Archive& archive);

private:
  std::vector<Eigen::Vector3d> points_;  ///< at equal distances from begin to end; empty: not held [m]
};

}  // namespace endovascular_sim::simulation
