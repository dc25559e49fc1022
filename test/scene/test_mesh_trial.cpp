#include "scene/mesh_trial.h"

#include <string>

#include <gtest/gtest.h>

#include "test/common/input_error_of.h"
#include "test/common/temporary_folder.h"
#include "vessel/anatomy/tube.h"
#include "vessel/centreline/centreline_file.h"
#include "vessel/io/mesh_reader.h"

namespace endovascular_sim::scene
{
namespace
{

class MeshTrialOfATube : public ::testing::Test
{
protected:
  /** Writes a tube with its centreline. @return the reason of a refusal */
  std::string write(double length, double curvature, double radius = 3e-3)
  {
    vessel::TubeShape shape;
    shape.radius = radius;
    shape.facet_length = radius / 3.0;
    shape.pieces = {{length, curvature, 0.0}};
    mesh_ = vessel::tubeMesh(shape);
    tree_ = vessel::tubeCentreline(shape);
    return refusal();
  }

  std::string refusal()
  {
    vessel::writeObj(mesh_, mesh_file_);
    vessel::writeCentreline(tree_, "tube", centreline_file_);
    return inputErrorOf([&] { trial_ = tryMesh(mesh_file_, centreline_file_); });
  }

  const TemporaryFolder folder_;
  const std::string mesh_file_ = folder_.file("mesh trial's #1.obj");
  const std::string centreline_file_ = folder_.file("mesh trial's #1.yaml");
  geometry::TriangleMesh mesh_;
  vessel::CentrelineTree tree_;
  MeshTrial trial_;
};

TEST_F(MeshTrialOfATube, AcceptsALongOneWithTheEntryOfTheScene)
{
  EXPECT_EQ(write(0.1, 0.0), "");
  EXPECT_FALSE(trial_.entry);
}

TEST_F(MeshTrialOfATube, RefusesOneThatBendsBeforeTheTipOfTheStraightWire)
{
  const std::string error = write(0.015, 200.0, 1e-3);
  EXPECT_NE(error.find("no wire can start at any of its ends"), std::string::npos) << error;
}

TEST_F(MeshTrialOfATube, RefusesAMeshWithoutTriangles)
{
  ASSERT_EQ(write(0.1, 0.0), "");
  mesh_ = {};
  EXPECT_NE(refusal(), "");
}

TEST_F(MeshTrialOfATube, RefusesACentrelineOutsideOfTheMesh)
{
  ASSERT_EQ(write(0.1, 0.0), "");
  for (Eigen::Vector3d& point : tree_.branches[0].points)
    point.x() += 0.02;
  EXPECT_NE(refusal().find("outside"), std::string::npos);
}

}  // namespace
}  // namespace endovascular_sim::scene
