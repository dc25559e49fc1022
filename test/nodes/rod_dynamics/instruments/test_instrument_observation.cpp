#include "nodes/rod_dynamics/instruments/instrument_observation.h"

#include <gtest/gtest.h>
#include <Eigen/Geometry>

#include "session/session.h"

namespace endovascular_sim::nodes
{
namespace
{

Eigen::Quaterniond orientationOf(const geometry_msgs::Pose& pose)
{
  return Eigen::Quaterniond(pose.orientation.w, pose.orientation.x, pose.orientation.y, pose.orientation.z);
}

}  // namespace

// The orientation was the shortest rotation to the tangent, whatever the handle's rotation.
TEST(TipPose, TurnsByNinetyDegreesAboutTheTangentWithTheHandleInFreeSpace)
{
  session::Session session("straight_wire", {"drive.initial_insertion=0.1", "drive.travel=0.1"});
  simulation::Simulation& simulation = session.simulation();
  const geometry_msgs::Pose begin = tipPose(simulation, 0);
  for (int k = 1; k <= 1000; ++k)
  {
    drive::HandCommand command;
    command.insertion = 0.1;
    command.rotation = 0.5 * M_PI * k / 1000;
    simulation.step(command);
  }
  const geometry_msgs::Pose end = tipPose(simulation, 0);
  const Eigen::AngleAxisd turn(orientationOf(end) * orientationOf(begin).inverse());
  const Eigen::Vector3d tangent = orientationOf(begin) * Eigen::Vector3d::UnitX();
  EXPECT_NEAR(turn.angle(), 0.5 * M_PI, 1e-9);
  EXPECT_GT(turn.axis().dot(tangent), 1.0 - 1e-9);
  EXPECT_NEAR(end.position.z, 0.1, 1e-9);
}

}  // namespace endovascular_sim::nodes
