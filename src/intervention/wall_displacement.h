#pragma once

#include <vector>

#include <Eigen/Core>

namespace endovascular_sim
{
class Archive;
}

namespace endovascular_sim::intervention
{

/** Wall displacement: vertices of the mesh that have moved. */
struct WallDisplacement
{
  std::vector<int> indices;                ///< vertex indices
  std::vector<Eigen::Vector3d> positions;  ///< new positions [m]
};

/** Saves or loads a wall displacement. */
void archive(Archive& archive, WallDisplacement& displacement);

}  // namespace endovascular_sim::intervention
