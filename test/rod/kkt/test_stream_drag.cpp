#include <cmath>
#include <functional>
#include <memory>

#include <gtest/gtest.h>

#include "rod/energy/energy_audit.h"
#include "rod/mixed/mixed_stepper.h"
#include "rod/paper/paper_stepper.h"
#include "rod/stepping/scheme_traits.h"
#include "test/rod/stack_fixtures.h"

// Drag of a stream on the nodes (StepInput::drags).

namespace endovascular_sim::rod
{
namespace
{

using Eigen::Matrix3d;
using Eigen::Vector3d;

constexpr double kEi = 1.6e-6;      // N·m²: soft tip of a guidewire
constexpr double kLength = 0.03;    // m
constexpr double kRadius = 1.8e-4;  // m
constexpr double kDensity = 6450.0;
constexpr double kSpeed = 0.5;              // m/s
constexpr double kPerLength = 0.077 / 0.5;  // N·s/m²: crosswise drag of that wire in blood at that speed
constexpr double kDt = 1e-3;                // s

/** Soft tip that is clamped at the origin. */
struct SoftTip
{
  explicit SoftTip(int nodes, StepperSettings settings = StepperSettings())
    : stepper(discretiseUniformly(uniformWire(clampedLength(kLength, nodes), kEi, kRadius, kDensity), nodes),
              clampAtOrigin(kLength, nodes), Environment(), settings),
      state(stepper.initialState(0.0, 0.0))
  {
  }

  KktStepper stepper;
  State state;
  StepInput input;
};

// --------------------------------------------------------------------------------------------- soft tip in a stream

/** State of an elastica over its arc length: angle, curvature, x, y. */
using Elastica = Eigen::Vector4d;

/** Elastica of unit length and stiffness under a load per length across its clamped direction, from its clamp with a
 *  curvature there: θ'' = −load (1 − s) cos θ, by Runge–Kutta steps of fourth order. */
Elastica endOfElastica(double load, double curvature)
{
  const auto slope = [load](double s, const Elastica& y)
  { return Elastica(y[1], -load * (1.0 - s) * std::cos(y[0]), std::cos(y[0]), std::sin(y[0])); };
  const int steps = 2000;
  const double h = 1.0 / steps;
  Elastica y(0.0, curvature, 0.0, 0.0);
  for (int k = 0; k < steps; ++k)
  {
    const double s = k * h;
    const Elastica a = slope(s, y);
    const Elastica b = slope(s + 0.5 * h, y + 0.5 * h * a);
    const Elastica c = slope(s + 0.5 * h, y + 0.5 * h * b);
    const Elastica d = slope(s + h, y + h * c);
    y += h / 6.0 * (a + 2.0 * b + 2.0 * c + d);
  }
  return y;
}

/** Tip of the elastica without moment at the tip, by shooting with bisection. */
Vector3d tipOfElastica(double load)
{
  double low = 0.0;
  double high = load;
  for (int k = 0; k < 60; ++k)
  {
    const double middle = 0.5 * (low + high);
    (endOfElastica(load, middle)[1] < 0.0 ? low : high) = middle;
  }
  const Elastica end = endOfElastica(load, low);
  return {end[2], end[3], 0.0};
}

TEST(StreamDrag, TheElasticaOfTheShootingMethodHasThePublishedTip)
{
  // Heavy cantilever of reference 06, wL³/EI = 10.
  EXPECT_NEAR((tipOfElastica(10.0) - Vector3d(0.6563537612385988, 0.7001997155143129, 0.0)).norm(), 0.0, 1e-9);
}

TEST(StreamDrag, ASoftTipAcrossAStreamRestsAtTheLargeDeflectionOfTheSameDeadLoadWithSecondOrder)
{
  const double load = kPerLength * kSpeed * std::pow(kLength, 3) / kEi;
  const Vector3d exact = tipOfElastica(load);
  EXPECT_GT(exact.y(), 0.1);
  double error[3];
  const int nodes[3] = {11, 21, 41};
  for (int k = 0; k < 3; ++k)
  {
    SoftTip tip(nodes[k]);
    tip.input.drags =
        uniformStream(tip.stepper.discretisation(), kPerLength * Matrix3d::Identity(), Vector3d(0.0, kSpeed, 0.0));
    ASSERT_GE(settle(tip.stepper, tip.state, tip.input, kDt, 1e-10, 2000), 0);
    error[k] = (tip.state.position.back() / kLength - exact).norm();
    RecordProperty("error_of_" + std::to_string(nodes[k]) + "_nodes", std::to_string(error[k]));
  }
  EXPECT_LT(error[0], 0.05 * exact.y());
  EXPECT_LT(error[1], 0.05 * exact.y());
  EXPECT_NEAR(std::log2(error[0] / error[1]), 2.0, 0.2);
  EXPECT_NEAR(std::log2(error[1] / error[2]), 2.0, 0.2);
}

// -------------------------------------------------------------------------------------------- wire that is carried

TEST(StreamDrag, AFreeWireTakesOverTheStreamAsBackwardEulerDoesAndNeverOvershoots)
{
  const Vector3d stream(0.3, 0.2, -0.1);
  const Vector3d per_length(0.02, 0.15, 0.08);  // N·s/m²
  Boundary boundary;
  boundary.introducer = false;
  for (const double density : {20.0, kDensity})
    for (const double dt : {1e-4, 1e-3, 1e-2})
    {
      KktStepper stepper(discretiseUniformly(uniformWire(kLength, kEi, kRadius, density), 11), boundary, Environment(),
                         StepperSettings());
      State state = stepper.initialState(0.0, 0.0);
      StepInput input;
      input.drags = uniformStream(stepper.discretisation(), per_length.asDiagonal(), stream);
      const double line_density = density * M_PI * kRadius * kRadius;
      const int steps = static_cast<int>(std::lround(0.3 / dt));
      double highest = 0.0;
      for (int k = 1; k <= steps; ++k)
      {
        ASSERT_TRUE(advanceFreely(stepper, state, input, dt).solved);
        for (const Vector3d& velocity : state.velocity)
          for (int axis = 0; axis < 3; ++axis)
          {
            const double share = velocity[axis] / stream[axis];
            highest = std::max(highest, share);
            EXPECT_NEAR(share, 1.0 - std::pow(1.0 + per_length[axis] * dt / line_density, -k), 1e-8);
          }
      }
      EXPECT_LE(highest, 1.0 + 1e-9) << dt;
      EXPECT_GT(state.velocity[5].y() / stream.y(), 1.0 - 1e-9) << dt;
    }
}

// --------------------------------------------------------------------------------------------------- orientation

/** Positions of a soft tip after 40 steps in an oblique stream that grows towards the tip, where everything is turned.
 *  @param turn rotation, or reflection */
std::vector<Vector3d> turnedTip(const Matrix3d& turn)
{
  const int nodes = 21;
  Boundary boundary = clampAtOrigin(kLength, nodes);
  boundary.origin = turn * boundary.origin;
  boundary.direction = turn * boundary.direction;
  boundary.director = turn * boundary.director;
  KktStepper stepper(discretiseUniformly(uniformWire(clampedLength(kLength, nodes), kEi, kRadius, kDensity), nodes),
                     boundary, Environment(), StepperSettings());
  Matrix3d root;
  root << 0.20, 0.05, -0.02, 0.03, 0.35, 0.04, 0.01, -0.06, 0.30;
  const Matrix3d per_length = root * root.transpose();
  State state = stepper.initialState(0.0, 0.0);
  StepInput input;
  const Discretisation& rod = stepper.discretisation();
  for (int i = 0; i < rod.nodes(); ++i)
    input.drags.push_back({i, rod.cell_length[i] * (turn * per_length * turn.transpose()),
                           turn * Vector3d(-0.1, 0.4 + 10.0 * rod.position[i], 0.3)});
  for (int k = 0; k < 40; ++k)
    EXPECT_TRUE(advanceFreely(stepper, state, input, kDt).solved);
  return state.position;
}

TEST(StreamDrag, RotatedAndMirroredStreamsGiveRotatedAndMirroredResults)
{
  const std::vector<Vector3d> plain = turnedTip(Matrix3d::Identity());
  EXPECT_GT(plain.back().tail<2>().norm(), 0.1 * kLength);
  const Matrix3d rotation = Eigen::AngleAxisd(2.1, Vector3d(0.3, -0.5, 0.8).normalized()).toRotationMatrix();
  const Matrix3d mirror = Vector3d(1.0, 1.0, -1.0).asDiagonal();
  for (const Matrix3d& turn : {rotation, mirror, Matrix3d(rotation * mirror)})
  {
    const std::vector<Vector3d> turned = turnedTip(turn);
    for (std::size_t i = 0; i < plain.size(); ++i)
      EXPECT_LT((turned[i] - turn * plain[i]).norm(), 1e-9) << i;
  }
}

// ----------------------------------------------------------------------------------------------------- zero drag

/** Hash of the state after a curved wire, or a stack, was pushed and turned. @param drags of its nodes */
std::uint64_t hashOfATurnedWire(bool stack, bool with_drags)
{
  const double length = 0.15;
  const std::vector<double> nodes = equalNodes(length, 76);
  const Wire wire = curvedTipWire(length, 0.02, 2e-5, 0.4e-3, 70.0);
  const Wire catheter = curvedTipWire(length, 0.03, 8e-5, 0.9e-3, 30.0);
  std::unique_ptr<KktStepper> stepper;
  if (stack)
    stepper = std::make_unique<KktStepper>(std::vector<Layer>{{wire}, {catheter}}, nodes, Boundary(), calm(),
                                           StepperSettings());
  else
    stepper = std::make_unique<KktStepper>(discretise(wire, nodes), Boundary(), calm(), StepperSettings());
  const std::vector<LayerInput> begin =
      stack ? std::vector<LayerInput>{{0.06, 0.0}, {0.05, 0.0}} : std::vector<LayerInput>{{0.06, 0.0}};
  State state = stepper->initialState(begin);
  StepInput input;
  if (with_drags)
    input.drags = uniformStream(stepper->discretisation(), Matrix3d::Zero(), Vector3d(0.5, -0.3, 0.2));
  for (int k = 1; k <= 60; ++k)
  {
    std::vector<LayerInput> now = begin;
    for (std::size_t m = 0; m < now.size(); ++m)
      now[m] = {begin[m].inserted_length + 1e-4 * static_cast<double>(m + 1) * k, 5e-3 * k};
    input.setHandles(now);
    EXPECT_TRUE(advanceFreely(*stepper, state, input, kDt).solved);
  }
  return state.hash();
}

TEST(StreamDrag, OfCoefficientZeroKeepsTheBitsOfAStepWithoutDrags)
{
  for (const bool stack : {false, true})
    EXPECT_EQ(hashOfATurnedWire(stack, true), hashOfATurnedWire(stack, false)) << stack;
}

// ------------------------------------------------------------------------------------------------------ bisection

/** Records the parts that a scheme accepts. */
class PartRecorder : public EnergyAudit
{
public:
  void addPart(const AcceptedPart& part) override
  {
    EnergyAudit::addPart(part);
    parts.push_back(part.dt);
  }

  std::vector<double> parts;  ///< durations [s]
};

TEST(StreamDrag, ABisectedStepEqualsTheStepsOfItsParts)
{
  StepperSettings settings;
  settings.max_iterations = 2;  // too few for a step of 100 ms of the straight wire
  const auto in_stream = [&settings](const std::vector<double>& steps, int& bisections, PartRecorder& recorder)
  {
    SoftTip tip(21, settings);
    tip.input.drags = uniformStream(tip.stepper.discretisation(), 200.0 * kPerLength * Matrix3d::Identity(),
                                    Vector3d(0.0, kSpeed, 0.0));
    tip.stepper.setObserver(&recorder);
    for (const double dt : steps)
    {
      const StepReport report = advanceFreely(tip.stepper, tip.state, tip.input, dt);
      EXPECT_TRUE(report.solved);
      bisections += report.bisections;
    }
    return tip.state.hash();
  };
  int bisections = 0;
  int in_parts = 0;
  PartRecorder whole, parts;
  const std::uint64_t hash = in_stream({0.1}, bisections, whole);
  EXPECT_GT(bisections, 0);
  EXPECT_EQ(in_stream(whole.parts, in_parts, parts), hash);
  EXPECT_EQ(in_parts, 0);
  EXPECT_NEAR(whole.balance().error(), 0.0, 1e-3 * whole.balance().turnover);
}

// ------------------------------------------------------------------------------------------------------ refusals

TEST(StreamDrag, IsRefusedAtNodesThatDoNotExistOrDoNotAscend)
{
  SoftTip tip(11);
  for (const std::vector<int>& nodes : {std::vector<int>{11}, {-1}, {3, 3}, {5, 4}})
  {
    tip.input.drags.clear();
    for (const int node : nodes)
      tip.input.drags.push_back({node, Matrix3d::Identity(), Vector3d::Zero()});
    EXPECT_THROW(advanceFreely(tip.stepper, tip.state, tip.input, kDt), std::invalid_argument);
  }
}

TEST(StreamDrag, IsRefusedBySchemesWithoutIt)
{
  EXPECT_TRUE(schemeTraits("kkt").streams);
  EXPECT_FALSE(schemeTraits("paper").streams);
  EXPECT_FALSE(schemeTraits("mixed").streams);
  const Wire wire = uniformWire(kLength, kEi, kRadius, kDensity);
  const Discretisation rod = discretiseUniformly(wire, 11);
  const Boundary boundary = clampAtOrigin(kLength, 11);
  PaperStepper paper(rod, boundary, Environment(), StepperSettings());
  MixedStepper mixed(wire, rod, boundary, Environment(), StepperSettings());
  StepInput input;
  input.drags.push_back({5, Matrix3d::Identity(), Vector3d::UnitY()});
  for (Stepper* stepper : std::initializer_list<Stepper*>{&paper, &mixed})
  {
    State state = stepper->initialState(0.0, 0.0);
    EXPECT_THROW(advanceFreely(*stepper, state, input, kDt), std::invalid_argument);
  }
}

}  // namespace
}  // namespace endovascular_sim::rod
