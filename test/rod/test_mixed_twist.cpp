#include "rod/mixed_twist.h"

#include <cmath>

#include <gtest/gtest.h>

#include "rod/mixed_statics.h"
#include "rod/mixed_stepper.h"
#include "rod_fixtures.h"

namespace endovascular_sim::rod
{
namespace
{

using Eigen::Vector3d;

/** A rod of EI = 1 clamped at the origin along x, with d1 along y. */
MixedRod unitRod(int edges, double length, double twist_flexibility, double curvature)
{
  MixedEdge edge;
  edge.length = length / edges;
  edge.flexibility = 1.0;
  edge.twist_flexibility = twist_flexibility;
  edge.material_curvature = Eigen::Vector2d(curvature, 0.0);
  return MixedRod(std::vector<MixedEdge>(static_cast<std::size_t>(edges), edge), {EndHold::kClamped, Vector3d::UnitX()},
                  {EndHold::kFree, Vector3d::UnitX()});
}

State equilibrium(MixedRod& rod, const Vector3d& tip_force, const TwistBoundary& twist)
{
  State state = rod.straight(Vector3d::Zero(), Vector3d::UnitX());
  EXPECT_TRUE(solveStatics(rod, {{rod.nodes() - 1, tip_force}}, StaticsSettings(), state, &twist).converged);
  return state;
}

// References 06c: 45° arc, GJ = EI and GJ = EI/1.3, loaded out of its plane with FR²/EI = 3.6. Second order, and about
// 200 times closer than Discrete Elastic Rods of the same nodes (5.6e-4 at 25).
TEST(MixedTwist, ArcBentOutOfItsPlaneConvergesWithSecondOrder)
{
  const Vector3d isotropic(0.5877968539120596, 0.2224503474206913, 0.4018828383798087);
  const Vector3d soft(0.5839083535454666, 0.2202658389805687, 0.40651206016496405);
  for (const auto& [flexibility, exact] : {std::make_pair(1.0, isotropic), std::make_pair(1.3, soft)})
  {
    const auto error = [flexibility = flexibility, exact = exact](int edges)
    {
      MixedRod rod = unitRod(edges, M_PI_4, flexibility, 1.0);
      return (equilibrium(rod, Vector3d(0.0, 0.0, 3.6), TwistBoundary()).position.back() - exact).norm();
    };
    const double middle = error(24);
    EXPECT_LT(middle, 7e-6);
    EXPECT_NEAR(std::log2(middle / error(48)), 2.0, 0.2);
  }
}

// References 06a: a quarter circle loaded in its plane, here with relaxed frames.
TEST(MixedTwist, ArcBentInItsPlaneKeepsFourthOrder)
{
  const Vector3d exact(0.804105101290247, 0.4818706970436423, 0.0);
  const auto error = [&exact](int edges)
  {
    MixedRod rod = unitRod(edges, 1.0, 1.3, M_PI_2);
    return (equilibrium(rod, Vector3d(0.0, -1.0, 0.0), TwistBoundary()).position.back() - exact).norm();
  };
  EXPECT_NEAR(std::log2(error(8) / error(16)), 4.0, 0.2);
}

TEST(MixedTwist, TorqueAtAFreeTipConvergesFasterThanSecondOrder)
{
  TwistBoundary twist;
  twist.tip_torque = 1.0;
  const auto tip = [&twist](int edges)
  {
    MixedRod rod = unitRod(edges, 1.0, 1.3, 0.0);
    const State state = equilibrium(rod, Vector3d(-1.0, -3.0, 1.0), twist);
    EXPECT_NEAR(state.hand_torque, -1.0, 1e-12);
    return state.position.back();
  };
  const Vector3d fine = tip(128);
  EXPECT_LT((tip(8) - fine).norm(), 1e-5);
  EXPECT_GT(std::log2((tip(16) - fine).norm() / (tip(32) - fine).norm()), 2.4);
}

TEST(MixedTwist, StraightWireTwistsAsALinearSpring)
{
  TwistBoundary twist;
  twist.tip_torque = 0.2;
  twist.rotation = 0.7;
  MixedRod rod = unitRod(10, 1.0, 1.3, 0.0);
  const State state = equilibrium(rod, Vector3d::Zero(), twist);
  for (int j = 0; j < 10; ++j)
    EXPECT_NEAR(state.twist_angle[j], 0.7 + 0.2 * 1.3 * (j + 0.5) / 10, 1e-12);
}

// References 07: the null test. A pre-curved wire's unloaded shape turns rigidly with the hand.
TEST(MixedTwist, UnloadedCurvedWireTurnsWithTheHandWithoutTorque)
{
  TwistBoundary twist;
  twist.rotation = M_PI_2;
  MixedRod rod = unitRod(12, 1.0, 1.3, 2.0);
  const State state = equilibrium(rod, Vector3d::Zero(), twist);
  EXPECT_LT((state.position.back() - Vector3d(std::sin(2.0) / 2.0, 0.0, (1.0 - std::cos(2.0)) / 2.0)).norm(), 3e-5);
  EXPECT_NEAR(state.hand_torque, 0.0, 1e-9);
}

TEST(MixedTwist, MovingWireComesToRestAtTheStaticShape)
{
  Wire wire = uniformWire(M_PI_4, 1.0, 0.02, 1000.0);
  wire.sections[0].torsional_stiffness = 1.0;
  wire.sections[0].rest_curvature = Eigen::Vector2d(1.0, 0.0);
  Boundary boundary;
  boundary.introducer = false;
  boundary.proximal = EndHold::kClamped;
  Environment environment;
  environment.damping = 5.0;
  MixedStepper stepper(wire, discretiseUniformly(wire, 13), boundary, environment, StepperSettings());
  State state = stepper.initialState(0.0, 0.0);
  StepInput input;
  input.forces.push_back({12, Vector3d(0.0, 0.0, 3.6)});
  PhaseTimer timer;
  for (int k = 0; k < 400; ++k)
  {
    std::uint32_t pass = 0;
    ASSERT_TRUE(stepper.step(state, input, 0.05, pass, nullptr, timer).solved);
  }
  MixedRod rod = unitRod(12, M_PI_4, 1.0, 1.0);
  const State rest = equilibrium(rod, Vector3d(0.0, 0.0, 3.6), TwistBoundary());
  EXPECT_LT((state.position.back() - rest.position.back()).norm(), 1e-8);
  EXPECT_NEAR(state.hand_torque, rest.hand_torque, 1e-7);
  EXPECT_GT(stepper.energy(state).twist, 0.0);
}

}  // namespace
}  // namespace endovascular_sim::rod
