#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <vector>

#include <Eigen/Core>

#include "endovascular_sim/VesselMesh.h"
#include "geometry/triangle_mesh.h"
#include "nodes/player/bag_timeline.h"

namespace endovascular_sim::nodes
{

/** Wall of a recording at any of its times: the recorded mesh, moved by all displacements up to then in their order. */
class RecordedWall
{
public:
  /** @param timeline outlives this object */
  explicit RecordedWall(const BagTimeline& timeline);

  /** Version of the wall at a time of the recording: that of the newest displacement, else that of the mesh; none
   *  before the mesh. */
  std::optional<std::uint64_t> versionAt(ros::Time time) const;

  /** Wall at a time of the recording, as vessel_server publishes it; none before the mesh. The message of a wall that
   * has not moved is the recorded one.
   *  @throws InputError when the mesh or a displacement is damaged */
  std::optional<VesselMesh> at(ros::Time time);

private:
  /** Displacements of one recorded mesh. */
  struct Origin
  {
    std::uint32_t mesh = 0;                    ///< entry
    std::uint64_t version = 0;                 ///< of the mesh
    std::vector<std::uint32_t> displacements;  ///< entries after the mesh
    std::vector<std::uint64_t> versions;       ///< of the wall after each
  };
  using Vertices = std::vector<Eigen::Vector3d>;

  const Origin* originAt(ros::Time time) const;
  std::size_t displacementsAt(const Origin& origin, ros::Time time) const;
  void goTo(const Origin& origin, std::size_t displacements);
  void keepSnapshot();

  const BagTimeline& timeline_;
  std::vector<Origin> origins_;      ///< in the order of their times
  const Origin* present_ = nullptr;  ///< origin of the wall below; null without one
  VesselMesh message_;               ///< recorded mesh of the origin
  geometry::TriangleMesh mesh_;      ///< wall after the first `moved_` displacements
  std::size_t moved_ = 0;
  std::map<std::size_t, Vertices> snapshots_;  ///< vertices of the present origin, by the number of displacements
  std::size_t spacing_ = 0;                    ///< least number of displacements between two snapshots
};

}  // namespace endovascular_sim::nodes
