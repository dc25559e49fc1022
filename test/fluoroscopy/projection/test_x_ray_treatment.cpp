#include "fluoroscopy/projection/x_ray_treatment.h"

#include <gtest/gtest.h>

#include "test/motion/motion_fixtures.h"

namespace endovascular_sim::fluoroscopy
{
namespace
{

TEST(MoveWires, MovesBalloonsAndStrutsWithTheVesselAndKeepsTheirRadii)
{
  const Eigen::Vector3d centre = motion::naturalHeart().fade.centre;
  const std::vector<Eigen::Vector3d> axis = {centre, centre + Eigen::Vector3d(0.0, 0.0, 0.01)};
  std::vector<XRayWire> wires = strutWires({axis}, 1e-4, {});
  wires.push_back(balloonWire(axis, {1.5e-3, 1.5e-3}, {}));
  const motion::MotionMap map = motion::mapAt(motion::endSystole(), motion::endInspiration());
  moveWires(map, wires);
  for (const XRayWire& wire : wires)
    for (std::size_t k = 0; k < 2; ++k)
      EXPECT_EQ(wire.nodes[k], map.position(axis[k]));
  EXPECT_GT((wires[1].nodes[0] - axis[0]).norm(), 2e-3);
  EXPECT_EQ(wires[1].profiles[0][0].radius, 1.5e-3);
}

TEST(MoveWires, LeavesWiresOfARestingPatient)
{
  std::vector<XRayWire> wires = {balloonWire({{0.1, 0.2, 0.3}, {0.1, 0.2, 0.4}}, {1e-3, 1e-3}, {})};
  moveWires(motion::mapAt(0.0, 0.0), wires);
  EXPECT_EQ(wires[0].nodes[1], Eigen::Vector3d(0.1, 0.2, 0.4));
}

}  // namespace
}  // namespace endovascular_sim::fluoroscopy
