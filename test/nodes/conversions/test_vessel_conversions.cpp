#include "nodes/conversions/vessel_conversions.h"

#include <limits>

#include <gtest/gtest.h>

#include "common/error.h"
#include "vessel/anatomy/tube.h"

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

TEST(VesselConversions, RestoreAMeshWithTheSameHash)
{
  const geometry::TriangleMesh mesh = vessel::tubeMesh(tube());
  VesselMesh message;
  toMessage(mesh, message);
  EXPECT_EQ(fromMessage(message).hash(), mesh.hash());
}

TEST(VesselConversions, RejectADamagedMesh)
{
  VesselMesh valid;
  toMessage(vessel::tubeMesh(tube()), valid);
  VesselMesh message = valid;
  message.mesh.vertices[5].x += 1e-9;
  EXPECT_THROW(fromMessage(message), InputError) << "another content hash";
  message = valid;
  message.mesh.vertices[5].x = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(fromMessage(message), InputError);
  message = valid;
  message.mesh.triangles[3].vertex_indices[1] = 0xffffffffU;
  EXPECT_THROW(fromMessage(message), InputError);
  EXPECT_THROW(fromMessage(VesselMesh()), InputError) << "without triangles";
}

TEST(VesselConversions, RestoreACentrelineBitForBit)
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

TEST(VesselConversions, RestoreLesionsAndRejectUnknownBranches)
{
  VesselCentreline message;
  toMessage(vessel::tubeCentreline(tube()), message);
  vessel::PlacedLesion lesion;
  lesion.branch = 0;
  lesion.begin = 0.01;
  lesion.middle = 0.02;
  lesion.end = 0.03;
  lesion.healthy_diameter = 6e-3;
  lesion.narrowed_diameter = 2e-3;
  toMessage({lesion}, message);
  const std::vector<vessel::PlacedLesion> back = lesionsFromMessage(message);
  ASSERT_EQ(back.size(), 1U);
  EXPECT_EQ(back[0].branch, lesion.branch);
  EXPECT_EQ(back[0].begin, lesion.begin);
  EXPECT_EQ(back[0].middle, lesion.middle);
  EXPECT_EQ(back[0].end, lesion.end);
  EXPECT_EQ(back[0].healthy_diameter, lesion.healthy_diameter);
  EXPECT_EQ(back[0].narrowed_diameter, lesion.narrowed_diameter);
  message.lesions[0].branch = 1;
  EXPECT_THROW(lesionsFromMessage(message), InputError);
}

TEST(VesselConversions, RestoreDisplacedVerticesBitForBit)
{
  const intervention::WallDisplacement displacement{{0, 7}, {{0.1, 1.0 / 3.0, -2e-3}, {0.0, 1e-9, 3.0}}};
  WallDisplacement message;
  toMessage(displacement, message);
  const intervention::WallDisplacement back = fromMessage(message, 8);
  EXPECT_EQ(back.indices, displacement.indices);
  EXPECT_EQ(back.positions, displacement.positions);
}

TEST(VesselConversions, RejectInvalidDisplacements)
{
  WallDisplacement message;
  toMessage(intervention::WallDisplacement{{0, 7}, {{0, 0, 0}, {0, 0, 0}}}, message);
  EXPECT_THROW(fromMessage(message, 7), InputError) << "the mesh has vertices 0 to 6";
  message.position.back().y = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(fromMessage(message, 8), InputError);
  message.position.pop_back();
  EXPECT_THROW(fromMessage(message, 8), InputError);
}

}  // namespace
}  // namespace endovascular_sim::nodes
