#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "rod/kkt/kkt_stepper.h"
#include "rod/sampling/resampling.h"
#include "test/rod/node_wall.h"
#include "test/rod/rod_fixtures.h"

namespace endovascular_sim::rod
{
namespace
{

constexpr double kLength = 0.062;
constexpr int kEdges = 31;           // odd: the lowest edge is level
constexpr double kCurvature = 20;    // 1/m
constexpr double kStiffness = 3e-4;  // N·m²
constexpr double kTimeStep = 1e-3;

/** A free wire on the floor, bent upwards by couples at its ends. */
struct Bowl
{
  Bowl() : coarse(discretise(wire, positions())), stepper(coarse, boundary(), environment(), StepperSettings())
  {
    floor.stiffness = 5e6;
    state = stepper.initialState(0.0, 0.0);
    for (int i = 0; i < coarse.nodes(); ++i)
    {
      const double angle = kCurvature * (coarse.position[i] - 0.5 * kLength);
      state.position[i] = {std::sin(angle) / kCurvature, 0.0, coarse.radius[i] + (1.0 - std::cos(angle)) / kCurvature};
    }
  }

  static std::vector<double> positions()
  {
    std::vector<double> result;
    for (int i = 0; i <= kEdges; ++i)
      result.push_back(kLength * i / kEdges);
    return result;
  }

  static Boundary boundary()
  {
    Boundary free;
    free.introducer = false;
    free.proximal = EndHold::kFree;
    return free;
  }

  static Environment environment()
  {
    Environment environment;
    environment.gravity = {0.0, 0.0, -9.81};
    environment.damping = 50.0;
    return environment;
  }

  void step()
  {
    const Discretisation& rod = stepper.discretisation();
    StepInput input;
    input.step = steps++;
    for (const int end : {0, rod.nodes() - 1})
    {
      const int next = end == 0 ? 1 : end - 1;
      const Eigen::Vector3d out = (state.position[end] - state.position[next]).normalized();
      const Eigen::Vector3d up = out.cross(Eigen::Vector3d(0.0, end == 0 ? -1.0 : 1.0, 0.0)).normalized();
      const Eigen::Vector3d force = kStiffness * kCurvature / rod.rest_length[end == 0 ? 0 : end - 1] * up;
      input.forces.push_back({end, up.z() > 0.0 ? force : Eigen::Vector3d(-force)});
      input.forces.push_back({next, -input.forces.back().force});
    }
    std::uint32_t pass = 0;
    PhaseTimer timer;
    stepper.step(state, input, kTimeStep, pass, &floor, timer);
  }

  double support() const
  {
    double sum = 0.0;
    for (const Eigen::Vector3d& force : state.wall_force)
      sum += force.z();
    return sum;
  }

  double weight() const
  {
    double mass = 0.0;
    for (const double m : coarse.mass)
      mass += m;
    return 9.81 * mass;
  }

  void change(const Discretisation& to)
  {
    const Discretisation from = stepper.discretisation();
    Resampling().carry(wire, from, to, state);
    stepper.resample(to);
  }

  Wire wire = uniformWire(kLength, kStiffness, 4e-4, 6450.0);
  Discretisation coarse;
  KktStepper stepper;
  State state;
  PlaneWall floor{0.0};
  std::uint64_t steps = 0;
};

TEST(ResamplingInContact, DoesNotPushANewNodeOffTheWallThatItsChordTouched)
{
  Bowl bowl;
  for (int k = 0; k < 1500; ++k)
    bowl.step();
  ASSERT_NEAR(bowl.support(), bowl.weight(), 0.01 * bowl.weight());
  std::vector<double> finer = Bowl::positions();
  finer.insert(finer.begin() + kEdges / 2 + 1, 0.5 * kLength);
  const Discretisation fine = discretise(bowl.wire, finer);
  const double lowest = bowl.state.position[kEdges / 2].z();
  bowl.change(fine);
  // The new node lies in the floor, which would push it with twenty times the wire's weight.
  const double depth = bowl.coarse.radius[0] - bowl.state.position[kEdges / 2 + 1].z();
  EXPECT_GT(5e6 * fine.cell_length[kEdges / 2 + 1] * depth, 20.0 * bowl.weight());
  double rose = 0.0;
  for (int k = 0; k < 200; ++k)
  {
    bowl.step();
    EXPECT_NEAR(bowl.support(), bowl.weight(), 0.1 * bowl.weight()) << "step " << k;
    rose = bowl.state.position[kEdges / 2].z() - lowest;
  }
  // Now the wire rests on its new node, higher by the sag of the arc over the old edge.
  const double h = kLength / kEdges;
  EXPECT_NEAR(rose, kCurvature * h * h / 8.0, 0.1 * kCurvature * h * h / 8.0);
}

}  // namespace
}  // namespace endovascular_sim::rod
