#include <algorithm>
#include <limits>
#include <tuple>

#include <gtest/gtest.h>

#include "rod/kkt/kkt_stepper.h"
#include "test/rod/node_wall.h"
#include "test/rod/rod_fixtures.h"

namespace endovascular_sim::rod
{
namespace
{

/** Radius of the wire [m], stiffness of the wall [N/m²]. */
class PressedWire : public testing::TestWithParam<std::tuple<double, double>>
{
};

TEST_P(PressedWire, KeepsItsAxisInTheLumenUnderAnyLoad)
{
  constexpr int kNodes = 20;
  const auto [radius, stiffness] = GetParam();
  Environment environment;
  environment.gravity = Eigen::Vector3d(0.0, 0.0, -1e8);  // some hundred newtons per node
  Boundary boundary;
  boundary.introducer = false;
  boundary.origin = Eigen::Vector3d(0.0, 0.0, radius + 0.1e-3);
  KktStepper stepper(discretiseUniformly(uniformWire(0.1, 4.9469e-5, radius, 7900.0), kNodes), boundary, environment,
                     StepperSettings());
  PlaneWall wall(0.0);
  wall.stiffness = stiffness;
  State state = stepper.initialState(0.0, 0.0);
  PhaseTimer timer;
  double lowest = state.position[0].z();
  for (int k = 0; k < 50; ++k)
  {
    std::uint32_t pass = 0;
    StepInput input;
    input.step = static_cast<std::uint64_t>(k);
    stepper.step(state, input, 1e-3, pass, &wall, timer);
    for (const Eigen::Vector3d& p : state.position)
      lowest = std::min(lowest, p.z());
  }
  EXPECT_GT(lowest, 0.0);
  EXPECT_LT(lowest, radius) << "no contact";
}

INSTANTIATE_TEST_SUITE_P(Wires, PressedWire,
                         testing::Combine(testing::Values(0.04e-3, 0.09e-3, 0.139e-3, 0.178e-3, 0.445e-3),
                                          testing::Values(1e6, std::numeric_limits<double>::infinity())));

}  // namespace
}  // namespace endovascular_sim::rod
