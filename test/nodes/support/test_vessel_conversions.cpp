#include "nodes/support/vessel_conversions.h"

#include <gtest/gtest.h>

#include "vessel/tube.h"

namespace endovascular_sim::nodes
{
namespace
{

vessel::TubeShape tube()
{
  vessel::TubeShape shape;
  shape.radius = 3e-3;
  shape.facet_length = 4e-3;
  shape.pieces = {{0.02, 0.0, 0.0}, {0.03, 30.0, 0.4}};
  return shape;
}

TEST(VesselConversions, AMeshComesBackWithTheSameHash)
{
  const vessel::TriangleMesh mesh = vessel::tubeMesh(tube());
  VesselMesh message;
  toMessage(mesh, message);
  EXPECT_EQ(fromMessage(message).hash(), mesh.hash());
}

TEST(VesselConversions, ACentrelineComesBackBitForBit)
{
  const vessel::CentrelineTree tree = vessel::tubeCentreline(tube());
  VesselCentreline message;
  toMessage(tree, message);
  const vessel::CentrelineTree back = fromMessage(message);
  ASSERT_EQ(back.branches.size(), tree.branches.size());
  EXPECT_EQ(back.branches[0].name, tree.branches[0].name);
  EXPECT_EQ(back.branches[0].parent, tree.branches[0].parent);
  EXPECT_EQ(back.branches[0].points, tree.branches[0].points);
  EXPECT_EQ(back.branches[0].radii, tree.branches[0].radii);
}

}  // namespace
}  // namespace endovascular_sim::nodes
