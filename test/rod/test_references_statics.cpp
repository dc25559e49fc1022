#include <Eigen/Dense>

#include <gtest/gtest.h>

#include "test/rod/rod_fixtures.h"

// Static shapes against the continuum (references 01, 02, 03, 06, 11) and against an independent solution of the same
// discrete equilibrium. L is the free length: a clamp acts at the middle of the clamped edge.

namespace endovascular_sim::rod
{
namespace
{

constexpr double kEi = 4.9469e-5;  // N·m²
constexpr double kLength = 0.38;
constexpr double kRadius = 1.8e-4;
constexpr double kDensity = 7900.0;
constexpr double kLongStep = 0.1;  // s; the wire's lowest frequency is 6 rad/s

StepperSettings exactSettings()
{
  StepperSettings settings;
  settings.max_iterations = 40;
  settings.strain_tolerance = 1e-6;  // further steps from rest reduce the strain
  return settings;
}

double orderOf(double coarse, double fine)
{
  return std::log2(coarse / fine);
}

// ------------------------------------------------------------------------------------------------- cantilevers

struct Cantilever
{
  double tip_load = 0.0;  ///< PL²/EI
  double weight = 0.0;    ///< wL³/EI
};

/** Nodes of the clamped wire at rest, over L; the clamp's middle is the origin, the load in −y. */
std::vector<Eigen::Vector3d> shapeOf(const Cantilever& cantilever, int nodes)
{
  const double line_density = kDensity * M_PI * kRadius * kRadius;
  Environment environment;
  environment.gravity.y() = -cantilever.weight * kEi / (std::pow(kLength, 3) * line_density);
  KktStepper stepper(discretiseUniformly(uniformWire(clampedLength(kLength, nodes), kEi, kRadius, kDensity), nodes),
                     clampAtOrigin(kLength, nodes), environment, exactSettings());
  State state = stepper.initialState(0.0, 0.0);
  StepInput input;
  input.forces.push_back({nodes - 1, Eigen::Vector3d(0.0, -cantilever.tip_load * kEi / (kLength * kLength), 0.0)});
  EXPECT_TRUE(relaxToEquilibrium(stepper, state, input, kLongStep));
  for (Eigen::Vector3d& x : state.position)
    x /= kLength;
  return state.position;
}

/** Order 2.0 ± 0.1 over three samplings, and within 2e-4 L at the finest. */
void expectSecondOrder(const Cantilever& cantilever, const Eigen::Vector3d& exact)
{
  double error[3];
  const int nodes[3] = {26, 51, 101};
  for (int k = 0; k < 3; ++k)
    error[k] = (shapeOf(cantilever, nodes[k]).back() - exact).norm();
  EXPECT_LT(error[2], 2e-4);
  EXPECT_NEAR(orderOf(error[0], error[1]), 2.0, 0.1);
  EXPECT_NEAR(orderOf(error[1], error[2]), 2.0, 0.1);
}

TEST(ReferencesStatics, TipOfTheElasticaConvergesWithSecondOrder)
{
  expectSecondOrder({1.0, 0.0}, {0.9435667637166234, -0.3017207737998133, 0.0});
  expectSecondOrder({10.0, 0.0}, {0.44500440224624865, -0.8106090248802966, 0.0});
}

TEST(ReferencesStatics, TipOfTheHeavyCantileverConvergesWithSecondOrder)
{
  expectSecondOrder({0.0, 10.0}, {0.6563537612385988, -0.7001997155143129, 0.0});
}

/** The same discrete equilibrium in the edges' angles, by Newton's method with a dense matrix: moments
 *  m = 4 tan(δ/2)/(h (1 + cos δ)) at the nodes, δ the turn, balance the loads beyond. */
std::vector<Eigen::Vector3d> independentShape(const Cantilever& cantilever, int nodes)
{
  const int n = nodes - 2;  // free edges
  const double h = 1.0 / (nodes - 1.5);
  Eigen::VectorXd beyond(n);  // load beyond each free edge
  double sum = cantilever.tip_load + 0.5 * h * cantilever.weight;
  for (int j = n - 1; j >= 0; --j)
  {
    beyond[j] = sum;
    sum += h * cantilever.weight;
  }
  Eigen::VectorXd angle = Eigen::VectorXd::Zero(n);
  const auto moment = [h](double turn) { return 4.0 * std::tan(0.5 * turn) / (h * (1.0 + std::cos(turn))); };
  const auto stiffness = [h](double turn)
  {
    const double c = 1.0 + std::cos(turn);
    return 4.0 / h * (1.0 / (c * c) + std::tan(0.5 * turn) * std::sin(turn) / (c * c));
  };
  for (int load = 1; load <= 20; ++load)
    for (int iteration = 0; iteration < 30; ++iteration)
    {
      Eigen::VectorXd residual(n);
      Eigen::MatrixXd matrix = Eigen::MatrixXd::Zero(n, n);
      for (int j = 0; j < n; ++j)
      {
        const double share = 0.05 * load * beyond[j] * h;
        const double turn = angle[j] - (j > 0 ? angle[j - 1] : 0.0);
        residual[j] = moment(turn) - share * std::cos(angle[j]);
        matrix(j, j) += stiffness(turn) + share * std::sin(angle[j]);
        if (j > 0)
          matrix(j, j - 1) -= stiffness(turn);
        if (j + 1 == n)
          continue;
        residual[j] -= moment(angle[j + 1] - angle[j]);
        matrix(j, j) += stiffness(angle[j + 1] - angle[j]);
        matrix(j, j + 1) -= stiffness(angle[j + 1] - angle[j]);
      }
      const Eigen::VectorXd step = matrix.partialPivLu().solve(residual);
      angle -= step;
      if (step.lpNorm<Eigen::Infinity>() < 1e-14)
        break;
    }
  std::vector<Eigen::Vector3d> shape = {{-0.5 * h, 0.0, 0.0}, {0.5 * h, 0.0, 0.0}};
  for (int j = 0; j < n; ++j)
    shape.push_back(shape.back() + h * Eigen::Vector3d(std::cos(angle[j]), -std::sin(angle[j]), 0.0));
  return shape;
}

TEST(ReferencesStatics, ShapesEqualAnIndependentSolutionOfTheSameDiscreteEquilibrium)
{
  for (const Cantilever& cantilever : {Cantilever{1.0, 0.0}, Cantilever{10.0, 0.0}, Cantilever{0.0, 10.0}})
  {
    const int nodes = 41;
    const std::vector<Eigen::Vector3d> shape = shapeOf(cantilever, nodes);
    const std::vector<Eigen::Vector3d> independent = independentShape(cantilever, nodes);
    for (int i = 0; i < nodes; ++i)
      EXPECT_LT((shape[i] - independent[i]).norm(), 1e-8) << "node " << i;
  }
}

// ------------------------------------------------------------------------------------- held at both ends

struct Buckled
{
  double force;       ///< PL²/EI
  double deflection;  ///< of the middle, over L
};

Buckled buckle(EndHold hold, int nodes)
{
  KktStepper stepper(discretiseUniformly(uniformWire(heldLength(kLength, nodes, hold), kEi, kRadius, kDensity), nodes),
                     heldAtBothEnds(kLength, nodes, hold), Environment(), exactSettings());
  State state = stepper.initialState(0.0, 0.0);
  StepInput input;
  input.forces.push_back({nodes / 2, Eigen::Vector3d(0.0, 1e-6, 0.0)});
  PhaseTimer timer;
  for (int k = 1; k <= 200; ++k)
  {
    std::uint32_t pass = 0;
    input.step = static_cast<std::uint64_t>(k);
    input.distal.displacement.x() = -0.1 * kLength * k / 200;
    for (Eigen::Vector3d& velocity : state.velocity)
      velocity.setZero();
    EXPECT_TRUE(stepper.step(state, input, 0.01, pass, nullptr, timer).solved);
  }
  input.forces.clear();
  EXPECT_TRUE(relaxToEquilibrium(stepper, state, input, kLongStep));
  const double scale = kEi / (kLength * kLength);
  EXPECT_NEAR(state.proximal_force.x(), -state.distal_force.x(), 1e-6 * scale);
  return {state.distal_force.x() / scale, std::abs(state.position[nodes / 2].y()) / kLength};
}

// Ends brought together by L/10.
TEST(ReferencesStatics, ABuckledWirePushesAndBulgesLikeEulersElastica)
{
  const Buckled clamped{41.57025579315579, 0.19492431137557378};
  const Buckled pinned{10.392563948288947, 0.19492431137557378};
  for (const auto& [hold, exact] :
       {std::make_pair(EndHold::kClamped, clamped), std::make_pair(EndHold::kPinned, pinned)})
  {
    const Buckled coarse = buckle(hold, 51);
    const Buckled fine = buckle(hold, 101);
    EXPECT_NEAR(fine.force, exact.force, 2e-4 * exact.force);
    EXPECT_NEAR(fine.deflection, exact.deflection, 1e-4);
    EXPECT_NEAR(orderOf(std::abs(coarse.force - exact.force), std::abs(fine.force - exact.force)), 2.0, 0.15);
    EXPECT_NEAR(orderOf(std::abs(coarse.deflection - exact.deflection), std::abs(fine.deflection - exact.deflection)),
                2.0, 0.15);
  }
}

// Catenary with a span of 0.8 L; the wire's EI is 1e-8 of its weight's scale w L³.
TEST(ReferencesStatics, AHeavySoftWireHangsInTheCatenary)
{
  const int nodes = 101;
  const double line_density = kDensity * M_PI * kRadius * kRadius;
  const double weight = 9.81 * line_density;  // per length
  Environment environment;
  environment.gravity.y() = -9.81;
  const double ei = 1e-8 * weight * std::pow(kLength, 3);
  KktStepper stepper(discretiseUniformly(uniformWire(kLength, ei, kRadius, kDensity), nodes),
                     heldAtBothEnds(kLength, nodes, EndHold::kPinned), environment, exactSettings());
  State state = stepper.initialState(0.0, 0.0);
  StepInput input;
  PhaseTimer timer;
  for (int k = 1; k <= 200; ++k)
  {
    std::uint32_t pass = 0;
    input.step = static_cast<std::uint64_t>(k);
    input.distal.displacement.x() = -0.2 * kLength * k / 200;
    for (Eigen::Vector3d& velocity : state.velocity)
      velocity.setZero();
    ASSERT_TRUE(stepper.step(state, input, 0.01, pass, nullptr, timer).solved);
  }
  ASSERT_TRUE(relaxToEquilibrium(stepper, state, input, kLongStep));
  EXPECT_NEAR(-state.position[nodes / 2].y() / kLength, 0.26543750913982356, 2e-4);
  EXPECT_NEAR(-state.distal_force.x() / (weight * kLength), 0.33820187908534965, 3e-4);
  EXPECT_NEAR(state.distal_force.norm() / (weight * kLength), 0.6036393882251733, 3e-4);
}

// ------------------------------------------------------------------------------------------ rest curvature

/** Tip, over the arc's radius, of a 45° arc under an out-of-plane load F R²/EI = 3.6 with GJ = EI. */
Eigen::Vector3d loadedArcTip(int nodes)
{
  const double radius = kLength / (0.25 * M_PI);
  Wire wire = uniformWire(clampedLength(kLength, nodes), kEi, kRadius, kDensity);
  wire.sections[0].torsional_stiffness = kEi;
  wire.sections[0].rest_curvature = Eigen::Vector2d(1.0 / radius, 0.0);
  KktStepper stepper(discretiseUniformly(wire, nodes), clampAtOrigin(kLength, nodes), Environment(), exactSettings());
  State state = stepper.initialState(0.0, 0.0);
  StepInput input;
  input.forces.push_back({nodes - 1, Eigen::Vector3d(0.0, 0.0, 3.6 * kEi / (radius * radius))});
  EXPECT_TRUE(relaxToEquilibrium(stepper, state, input, kLongStep));
  return state.position.back() / radius;
}

// Cantilever with natural curvature, loaded out of its plane.
TEST(ReferencesStatics, AnArcUnderAnOutOfPlaneLoadBendsAndTwistsLikeTheKirchhoffRod)
{
  const Eigen::Vector3d exact(0.5877968539120596, 0.2224503474206913, 0.4018828383798087);
  const double coarse = (loadedArcTip(26) - exact).norm();
  const double fine = (loadedArcTip(51) - exact).norm();
  const double finest = (loadedArcTip(101) - exact).norm();
  EXPECT_LT(finest, 2e-4);
  EXPECT_NEAR(orderOf(coarse, fine), 2.0, 0.1);
  EXPECT_NEAR(orderOf(fine, finest), 2.0, 0.1);
}

// ------------------------------------------------------------------------------------------- unit energies

// Three nodes with a turn of p: E h/EI = 2 tan²(p/2).
TEST(ReferencesStatics, EnergyOfOneTurnIsExact)
{
  for (const auto& [turn, energy] :
       {std::make_pair(0.01, 5.0000833345139046e-05), std::make_pair(0.5, 0.13039899346569978),
        std::make_pair(1.0, 0.5968928208190496), std::make_pair(2.0, 4.851037641629518)})
  {
    const double edge = 1e-3;
    Boundary boundary;
    boundary.introducer = false;
    KktStepper stepper(discretiseUniformly(uniformWire(2.0 * edge, kEi, kRadius, kDensity), 3), boundary, Environment(),
                       StepperSettings());
    State state = stepper.initialState(0.0, 0.0);
    state.position[2] = state.position[1] + edge * Eigen::Vector3d(std::cos(turn), 0.0, std::sin(turn));
    EXPECT_NEAR(stepper.energy(state).bending * edge / kEi, energy, 1e-12 * energy);
  }
}

}  // namespace
}  // namespace endovascular_sim::rod
