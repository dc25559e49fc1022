#include "rod/mixed/mixed_rod.h"

#include <gtest/gtest.h>

#include "rod/model/turning_angle.h"
#include "test/rod/mixed/mixed_lagrangian.h"

namespace endovascular_sim::rod
{
namespace
{

using Eigen::Vector3d;

/** Deterministic pseudo-random numbers in −1 … 1. */
class Numbers
{
public:
  double next()
  {
    seed_ = seed_ * 6364136223846793005ull + 1442695040888963407ull;
    return static_cast<double>(seed_ >> 11) / 4503599627370496.0 - 1.0;
  }
  Vector3d vector() { return Vector3d(next(), next(), next()); }

private:
  std::uint64_t seed_ = 12345;
};

MixedRod unevenRod(EndHold hold, Numbers& numbers)
{
  std::vector<MixedEdge> edges;
  for (int j = 0; j < 5; ++j)
  {
    MixedEdge edge;
    edge.length = 0.2 + 0.05 * numbers.next();
    edge.flexibility = 1.0 + 0.5 * numbers.next();
    edge.axial_compliance = 0.01;
    edge.rest_curvature = {2.0 * numbers.vector(), 2.0 * numbers.vector()};
    edge.load = 30.0 * numbers.vector();
    edges.push_back(edge);
  }
  return MixedRod(edges, {hold, Vector3d(0.8, 0.0, 0.6)}, {hold, Vector3d(0.6, 0.8, 0.0)});
}

State bentState(const MixedRod& rod, Numbers& numbers)
{
  State state = rod.straight(Vector3d::Zero(), Vector3d::UnitX());
  for (int i = 0; i < rod.nodes(); ++i)
  {
    state.position[i] += 0.08 * numbers.vector();
    state.moment[i] = 2.0 * numbers.vector();
  }
  for (double& tension : state.tension)
    tension = 5.0 * numbers.next();
  return state;
}

/** Adds a value to the unknown of a row. */
void nudge(const MixedRod& rod, State& state, int row, double by)
{
  for (int i = state.first_node; i < rod.nodes(); ++i)
    for (int axis = 0; axis < 3; ++axis)
    {
      if (rod.positionRow(state, i) + axis == row)
        state.position[i][axis] += by;
      if (rod.momentRow(state, i) + axis == row)
        state.moment[i][axis] += by;
    }
  for (int j = state.first_node; j + 1 < rod.nodes(); ++j)
    if (rod.tensionRow(state, j) == row)
      state.tension[j] += by;
}

struct Derivatives
{
  std::vector<double> gradient;
  MixedRod::Matrix hessian;

  Derivatives(const MixedRod& rod, const State& state) : gradient(static_cast<std::size_t>(rod.size(state)), 0.0)
  {
    hessian.reset(rod.size(state));
    rod.assemble(state, gradient, hessian);
  }
};

TEST(TurningAngle, SeriesAndClosedFormAgreeAndZeroIsRegular)
{
  const AngleOverSine straight(1.0);
  EXPECT_EQ(straight.value, 1.0);
  EXPECT_NEAR(straight.first, -1.0 / 3.0, 1e-15);
  EXPECT_NEAR(straight.second, 4.0 / 15.0, 1e-15);
  for (const double border : {0.1, 0.004})
  {
    const AngleOverSine below(1.0 - border * (1.0 - 1e-12));
    const AngleOverSine above(1.0 - border * (1.0 + 1e-12));
    EXPECT_NEAR(below.value, above.value, 1e-12);
    EXPECT_NEAR(below.first, above.first, 1e-12);
    EXPECT_NEAR(below.second, above.second, 1e-11);
  }
  const AngleOverSine right(0.0);
  EXPECT_NEAR(right.value, M_PI_2, 1e-15);
}

TEST(MixedRod, GradientEqualsFiniteDifferencesOfTheLagrangian)
{
  for (const EndHold hold : {EndHold::kFree, EndHold::kPinned, EndHold::kClamped})
  {
    Numbers numbers;
    const MixedRod rod = unevenRod(hold, numbers);
    const State state = bentState(rod, numbers);
    const Derivatives exact(rod, state);
    const double step = 1e-6;
    for (int row = 0; row < rod.size(state); ++row)
    {
      State up = state;
      State down = state;
      nudge(rod, up, row, step);
      nudge(rod, down, row, -step);
      EXPECT_NEAR(exact.gradient[row], (lagrangian(rod, up) - lagrangian(rod, down)) / (2.0 * step), 1e-7) << row;
    }
  }
}

TEST(MixedRod, SecondDerivativesEqualFiniteDifferencesOfTheGradient)
{
  for (const EndHold hold : {EndHold::kFree, EndHold::kClamped})
  {
    Numbers numbers;
    const MixedRod rod = unevenRod(hold, numbers);
    const State state = bentState(rod, numbers);
    const Derivatives exact(rod, state);
    const double step = 1e-6;
    for (int row = 0; row < rod.size(state); ++row)
    {
      State up = state;
      State down = state;
      nudge(rod, up, row, step);
      nudge(rod, down, row, -step);
      const Derivatives above(rod, up);
      const Derivatives below(rod, down);
      for (int other = 0; other < rod.size(state); ++other)
      {
        const int distance = std::abs(row - other);
        const double entry =
            distance <= MixedRod::kBandwidth ? exact.hessian.at(std::max(row, other), std::min(row, other)) : 0.0;
        EXPECT_NEAR(entry, (above.gradient[other] - below.gradient[other]) / (2.0 * step), 2e-6) << row << " " << other;
      }
    }
  }
}

TEST(MixedRod, InternalForcesOfAFreeRodHaveNoResultant)
{
  Numbers numbers;
  MixedRod rod = unevenRod(EndHold::kFree, numbers);
  State state = bentState(rod, numbers);
  for (int j = 0; j + 1 < rod.nodes(); ++j)
    rod.edge(j).load.setZero();
  state.moment.front().setZero();
  state.moment.back().setZero();
  const Derivatives derivatives(rod, state);
  Vector3d force = Vector3d::Zero();
  for (int i = 0; i < rod.nodes(); ++i)
    for (int axis = 0; axis < 3; ++axis)
      force[axis] += derivatives.gradient[rod.positionRow(state, i) + axis];
  EXPECT_LT(force.norm(), 1e-12);
}

TEST(MixedRod, EdgesAverageTheFlexibilityOfTheSectionsTheySpan)
{
  Wire wire;
  Section section;
  section.length = 0.1;
  section.bending_stiffness = 2.0;
  section.axial_stiffness = 10.0;
  wire.sections = {section, section};
  wire.sections[1].bending_stiffness = 0.5;
  const std::vector<MixedEdge> edges = mixedEdges(wire, {0.0, 0.1, 0.2});
  EXPECT_NEAR(edges[0].flexibility, 0.5, 1e-15);
  EXPECT_NEAR(edges[1].flexibility, 2.0, 1e-15);
  EXPECT_NEAR(mixedEdges(wire, {0.0, 0.05, 0.2})[1].flexibility, (0.5 + 2.0 * 2.0) / 3.0, 1e-15);
}

}  // namespace
}  // namespace endovascular_sim::rod
