#pragma once

#include <optional>
#include <string>
#include <vector>

#include <Eigen/Core>

namespace endovascular_sim::scene
{

/** Result of a trial of a mesh in the bundled scene `mesh`. */
struct MeshTrial
{
  std::optional<Eigen::Vector3d> entry;  ///< `entry.position` that the scene needs [m]; empty: that of the scene suits
  std::vector<std::string> warnings;
};

/** Tries a mesh in metres with its centreline as `simulate config/scenes/mesh.yaml` does before its first step: checks
 * of mesh, centreline and entry. The entry is that of the scene, or else the first end of the centreline at which the
 * wire can start.
 *  @throws InputError with the reason of the simulator */
MeshTrial tryMesh(const std::string& mesh, const std::string& centreline);

}  // namespace endovascular_sim::scene
