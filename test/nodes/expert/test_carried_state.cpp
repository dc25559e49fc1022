#include "nodes/expert/carried_state.h"

#include <gtest/gtest.h>

namespace endovascular_sim::nodes
{
namespace
{

/** Fade around the origin, 20 mm to 100 mm. */
motion::MotionMap mapWith(const Eigen::Vector3d& shift)
{
  motion::HeartFrame frame;
  frame.fade.core = 0.02;
  frame.fade.reach = 0.1;
  motion::MotionField field;
  field.shift = shift;
  return {frame, field, {}};
}

RodStateVisual stateAt(const Eigen::Vector3d& point)
{
  RodStateVisual state;
  state.nodes.resize(1);
  state.nodes[0].x = point.x();
  state.nodes[0].y = point.y();
  state.nodes[0].z = point.z();
  return state;
}

Eigen::Vector3d nodeOf(const RodStateVisual& state)
{
  return {state.nodes[0].x, state.nodes[0].y, state.nodes[0].z};
}

TEST(CarriedState, LiesWhereThePlaceAtRestIsInTheOtherMotion)
{
  const motion::MotionMap expert = mapWith({0.0, 0.0, -8e-3}), trainee = mapWith({5e-3, 0.0, 0.0});
  for (const Eigen::Vector3d& rest : {Eigen::Vector3d(1e-3, 2e-3, 3e-3), Eigen::Vector3d(0.05, 0.01, -0.02)})
  {
    RodStateVisual state = stateAt(expert.position(rest));
    carry(expert, trainee, state);
    EXPECT_LT((nodeOf(state) - trainee.position(rest)).norm(), 1e-12);
  }
}

TEST(CarriedState, StaysBitForBitInPatientsAtRestAndOutsideOfTheFade)
{
  const motion::MotionMap rest = mapWith(Eigen::Vector3d::Zero());
  const Eigen::Vector3d point(0.0123456789, 0.02, 0.03), outside(0.3, 0.2, 0.1);
  RodStateVisual state = stateAt(point);
  carry(rest, rest, state);
  EXPECT_EQ(nodeOf(state), point);
  state = stateAt(outside);
  carry(rest, mapWith({5e-3, 0.0, 0.0}), state);
  EXPECT_EQ(nodeOf(state), outside);
}

}  // namespace
}  // namespace endovascular_sim::nodes
