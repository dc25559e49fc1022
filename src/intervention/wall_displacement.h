#pragma once

#include <cstddef>
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

/** Displacement that leads from vertices to others of the same mesh.
 *  @param from, to of equal length [m] */
WallDisplacement displacementBetween(const std::vector<Eigen::Vector3d>& from, const std::vector<Eigen::Vector3d>& to);

/** Moves vertices. @param displacement with indices of @p vertices */
void move(const WallDisplacement& displacement, std::vector<Eigen::Vector3d>& vertices);

/** Saves or loads a wall displacement. */
void archive(Archive& archive, WallDisplacement& displacement);

/** Checks a loaded displacement.
 *  @param vertices number of vertices of the mesh
 *  @throws ArchiveError when indices are out of range, or positions are missing or not finite */
void requireFit(const WallDisplacement& displacement, std::size_t vertices);

}  // namespace endovascular_sim::intervention
