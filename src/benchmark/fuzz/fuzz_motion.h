#pragma once

#include <memory>
#include <vector>

#include "benchmark/fuzz/fuzz_random.h"
#include "benchmark/fuzz/fuzz_vessels.h"
#include "scene/scene_vessel.h"
#include "simulation/motion_coupling.h"

namespace endovascular_sim::benchmark
{

/** Random motion of a fuzzed vessel: a heart of 10 mm at 90 beats per minute beside which the wire enters. */
simulation::PatientMotion randomMotion(const FuzzVessel& vessel, const scene::EntryPose& entry, double time_step,
                                       FuzzRandom& random);

/** Checks of a wire in a vessel that moves, against the moved mesh: all of its vertices are moved by the map. */
class MovedVesselCheck
{
public:
  /** @param mesh at rest; must outlive this
   *  @param bounds of the motion in the lumen */
  MovedVesselCheck(const geometry::TriangleMesh& mesh, const motion::MapBounds& bounds)
    : mesh_(mesh), moved_(mesh), bounds_(bounds)
  {
  }

  /** Signed distance of a point from the moved mesh by brute force, positive in the lumen [m]. */
  double bruteSignedDistance(const motion::MotionMap& map, const Eigen::Vector3d& point);

  /** Check of a whole wire. Its allowances grow by the sag of its edges and of those of the mesh, which the map bends.
   *  @param nodes in the moved patient */
  WireFinding check(const motion::MotionMap& map, std::vector<CheckedNode> nodes);

private:
  void move(const motion::MotionMap& map);

  const geometry::TriangleMesh& mesh_;
  geometry::TriangleMesh moved_;
  motion::MapBounds bounds_;
};

}  // namespace endovascular_sim::benchmark
