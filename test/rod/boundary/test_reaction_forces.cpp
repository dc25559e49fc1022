#include "rod/boundary/reaction_forces.h"

#include <gtest/gtest.h>

#include <memory>

#include "rod/boundary/introducer_guide.h"
#include "rod/mixed/mixed_stepper.h"
#include "rod/paper/paper_stepper.h"
#include "test/rod/rod_fixtures.h"

namespace endovascular_sim::rod
{
namespace
{

TEST(Remainder, IsRightHandSideLessTheMatrixTimesTheSolution)
{
  BandedLdlt<4> matrix;
  matrix.reset(9);
  Eigen::MatrixXd dense = Eigen::MatrixXd::Zero(9, 9);
  for (int col = 0; col < 9; ++col)
    for (int row = col; row < 9 && row <= col + 4; ++row)
      dense(row, col) = dense(col, row) = matrix.at(row, col) =
          std::sin(3.0 * row + 7.0 * col) + (row == col ? 5.0 : 0.0);
  std::vector<double> solution;
  for (int k = 0; k < 9; ++k)
    solution.push_back(std::cos(k));
  const Eigen::VectorXd product = dense * Eigen::Map<const Eigen::VectorXd>(solution.data(), 9);
  const Eigen::Vector3d rhs(1.0, -2.0, 0.5);
  for (const int row : {0, 3, 6})
    EXPECT_LT((remainder(matrix, rhs, solution, row) - (rhs - product.segment<3>(row))).norm(), 1e-14) << row;
}

constexpr double kEi = 1e-4;
constexpr double kRadius = 1.8e-4;
constexpr double kDensity = 8000.0;

std::unique_ptr<Stepper> makeStepper(const std::string& scheme, const Wire& wire, int nodes, const Boundary& boundary,
                                     const Environment& environment)
{
  StepperSettings settings;
  settings.strain_tolerance = 1e-7;
  Discretisation rod = discretiseUniformly(wire, nodes);
  if (scheme == "kkt")
    return std::make_unique<KktStepper>(rod, boundary, environment, settings);
  if (scheme == "paper")
    return std::make_unique<PaperStepper>(rod, boundary, environment, settings);
  return std::make_unique<MixedStepper>(wire, rod, boundary, environment, settings);
}

class ForceOnTheHand : public testing::TestWithParam<std::string>
{
};

INSTANTIATE_TEST_SUITE_P(OfEveryScheme, ForceOnTheHand, testing::Values("kkt", "paper", "mixed"),
                         [](const auto& scheme) { return scheme.param; });

// At rest the force on the hand is the axial load less the configurational force, by which the guide pushes the wire
// out.
TEST_P(ForceOnTheHand, OfAWireBentInItsGuideIsTheAxialLoadLessTheConfigurationalForce)
{
  const Wire wire = uniformWire(0.1, kEi, kRadius, kDensity);
  Boundary boundary;
  Environment environment;
  environment.damping = 400.0;
  const int nodes = 41;
  const auto stepper = makeStepper(GetParam(), wire, nodes, boundary, environment);
  State state = stepper->initialState(0.03, 0.0);
  StepInput input;
  input.inserted_length = 0.03;
  input.forces.push_back({nodes - 1, Eigen::Vector3d(-0.02, 0.1, 0.05)});
  ASSERT_GE(settle(*stepper, state, input, 1e-3, 1e-10, 20000), 0);
  const double bent = (state.position[state.first_node + 2] - state.position[state.first_node + 1])
                          .normalized()
                          .cross(boundary.direction)
                          .norm();
  EXPECT_GT(bent, 0.0);
  double push = 0.0;
  IntroducerGuide(boundary).forEachEdge(stepper->discretisation(), state,
                                        [&push, &boundary](int /*edge*/, const GuidedEdge& edge)
                                        { push -= boundary.direction.dot(edge.gradient[0] + edge.gradient[1]); });
  const double moment = 0.03 * std::hypot(0.1, 0.05);
  EXPECT_NEAR(push, 0.5 * moment * moment / kEi, 0.3 * push);  // ½EIκ² of the nearly straight wire
  // Each linear step of `paper` leaves the equilibrium a little, and its projection returns.
  EXPECT_NEAR(state.hand_force, 0.02 - push, GetParam() == "paper" ? 1e-5 : 1e-6);
}

// The change of momentum is the impulse of the loads and of the hold.
TEST_P(ForceOnTheHand, BalancesTheMomentumOfASwingingWire)
{
  const double length = 0.1;
  const int nodes = 31;
  const Wire wire = uniformWire(length, kEi, kRadius, kDensity);
  Boundary boundary;
  boundary.introducer = false;
  boundary.proximal = EndHold::kClamped;
  const auto stepper = makeStepper(GetParam(), wire, nodes, boundary, Environment());
  State state = stepper->initialState(0.0, 0.0);
  const auto momentum = [&]
  {
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    const auto* mixed = dynamic_cast<const MixedStepper*>(stepper.get());
    for (int i = 0; i < nodes; ++i)
      sum += (mixed ? mixed->mass()[i][0] + mixed->mass()[i][1] + (i > 0 ? mixed->mass()[i - 1][1] : 0.0)
                    : stepper->discretisation().mass[i]) *
             state.velocity[i];
    return sum;
  };
  StepInput input;
  input.forces.push_back({nodes - 1, Eigen::Vector3d(-0.01, 0.05, 0.0)});
  const double dt = 1e-4;
  PhaseTimer timer;
  double largest = 0.0;
  for (int k = 0; k < 100; ++k)
  {
    const Eigen::Vector3d before = momentum();
    std::uint32_t pass = 0;
    input.step = static_cast<std::uint64_t>(k);
    stepper->step(state, input, dt, pass, nullptr, timer);
    const Eigen::Vector3d force = (momentum() - before) / dt;
    EXPECT_LT((force - input.forces[0].force + state.proximal_force).norm(), 1e-6) << k;
    EXPECT_EQ(state.hand_force, -state.proximal_force.x());
    largest = std::max(largest, state.proximal_force.norm());
  }
  EXPECT_GT(largest, 0.05);
}

}  // namespace
}  // namespace endovascular_sim::rod
