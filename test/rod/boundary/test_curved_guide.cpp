#include "rod/boundary/curved_guide.h"

#include <cmath>

#include <gtest/gtest.h>

#include "test/rod/rod_fixtures.h"

namespace endovascular_sim::rod
{
namespace
{

using Eigen::Vector3d;

constexpr double kEdge = 3e-3;     // m
constexpr double kCurved = 10e-3;  // curved end of the wire [m]

/** A wire in the introducer whose end bends in a plane of its rest curvature. */
struct CurvedEnd
{
  Boundary boundary;
  Discretisation rod;
  TwistBoundary hold;
  State state;

  explicit CurvedEnd(double inserted)
  {
    Section shaft = uniformWire(0.06 - kCurved, 1e-4, 4e-4, 6450.0).sections.front();
    Section end = shaft;
    end.length = kCurved;
    end.rest_curvature.x() = 100.0;
    Wire wire;
    wire.sections = {shaft, end};
    rod = discretiseUniformly(wire, 21);
    hold.position = rod.length() - inserted;
    hold.half_width = 1.5e-3;
    const auto n = static_cast<std::size_t>(rod.nodes());
    state.position.resize(n);
    state.twist_angle.assign(n - 1, 0.0);
    state.position[0] = (inserted - rod.length()) * Vector3d::UnitX();
    double angle = 0.0;
    for (std::size_t i = 1; i < n; ++i)
    {
      const double from_mouth = state.position[i - 1].x();
      angle += from_mouth > -3e-3 ? 0.12 + 10.0 * from_mouth : 0.0;
      state.position[i] = state.position[i - 1] + kEdge * Vector3d(std::cos(angle), std::sin(angle), 0.0);
    }
  }

  double energy() const
  {
    const IntroducerGuide guide(boundary);
    double sum = 0.0;
    CurvedGuide(guide).forEachEdge(rod, hold, state,
                                   [&sum](int /*edge*/, const CurvedGuideTerm& term) { sum += term.edge.energy; });
    return sum;
  }
};

TEST(CurvedGuide, ForcesAreTheDerivativesOfItsEnergy)
{
  for (const double inserted : {5e-3, 7.3e-3, 9.1e-3})
  {
    SCOPED_TRACE(inserted);
    CurvedEnd end(inserted);
    std::vector<Vector3d> gradient(end.state.position.size(), Vector3d::Zero());
    double by_mouth = 0.0;
    const IntroducerGuide guide(end.boundary);
    CurvedGuide(guide).forEachEdge(end.rod, end.hold, end.state,
                                   [&](int edge, const CurvedGuideTerm& term)
                                   {
                                     for (int k = 0; k < 4; ++k)
                                       if (term.spread[k] != 0.0)
                                         gradient[edge - 1 + k] += term.spread[k] * term.edge.by_bow.even;
                                     gradient[edge] += term.edge.gradient[0];
                                     gradient[edge + 1] += term.edge.gradient[1];
                                     by_mouth += term.by_mouth;
                                   });
    double largest = 0.0;
    for (const Vector3d& force : gradient)
      largest = std::max(largest, force.norm());
    ASSERT_GT(largest, 0.1);
    const double step = 1e-8;
    const auto slope = [&](double& value)
    {
      const double middle = value;
      value = middle + step;
      const double above = end.energy();
      value = middle - step;
      const double below = end.energy();
      value = middle;
      return (above - below) / (2.0 * step);
    };
    for (std::size_t i = 0; i < gradient.size(); ++i)
      for (int axis = 0; axis < 3; ++axis)
        EXPECT_NEAR(gradient[i][axis], slope(end.state.position[i][axis]), 1e-5 * largest) << i << ' ' << axis;
    EXPECT_GT(std::abs(by_mouth), 1e-3);
    EXPECT_NEAR(by_mouth, slope(end.hold.position), 1e-5 * largest);
  }
}

/** Sum of RestBow and of the curve by the mean of the nodes, against the curve of the rest curvature: the offset of the
 *  middle of an edge with a joint in it. */
TEST(CurvedGuide, AnEdgeWithAJointHasTheOffsetOfItsOwnRestCurvature)
{
  const CurvedEnd end(0.03);
  const int edge = static_cast<int>((end.rod.length() - kCurved) / kEdge);
  const RestBow bow = restBowAt(end.rod, end.hold.mouth(), edge);
  const double mean = 0.5 / kEdge *
                      (restAngle(end.rod.curved_parts, end.rod.position, edge).x() +
                       restAngle(end.rod.curved_parts, end.rod.position, edge + 1).x());
  // Twice the integral of curvature, from the joint on, times the lesser distance from an end.
  const double joint = (end.rod.length() - kCurved - end.rod.position[edge]) / kEdge;
  double offset = 0.0;
  constexpr int kPoints = 3000;
  for (int k = 0; k < kPoints; ++k)
  {
    const double t = (k + 0.5) / kPoints;
    offset += t > joint ? 100.0 * 6.0 * t * (1.0 - t) / kPoints : 0.0;
  }
  EXPECT_NEAR(bow.even.x() - 0.125 * kEdge * kEdge * mean, -0.125 * kEdge * kEdge * offset, 1e-3 * kEdge * kEdge);
  EXPECT_EQ(0.0, bow.even.y());
}

TEST(CurvedGuide, UniformRestCurvatureBeyondTheMouthHasNoBow)
{
  const CurvedEnd end(0.03);
  const RestBow bow = restBowAt(end.rod, end.hold.mouth(), end.rod.nodes() - 3);
  EXPECT_NEAR(0.0, bow.even.norm(), 1e-12);
  EXPECT_NEAR(0.0, bow.odd.norm(), 1e-12);
}

/** Energy of an arc through nodes that leave the axis at a place between two of them.
 *  @param curved false: of the chords */
double arcEnergy(double edge, double shift, bool curved)
{
  const double radius = 0.01;
  CurvedEnd wire(0.03);
  const IntroducerGuide guide(wire.boundary);
  const int n = static_cast<int>(0.03 / edge);
  wire.rod = discretiseUniformly(uniformWire(n * edge, 1e-4, 4e-4, 6450.0), n + 1);
  wire.state.position.clear();
  for (int i = 0; i <= n; ++i)
  {
    const double at = -0.016 + (i + shift) * edge;
    const double angle = std::max(0.0, at) / radius;
    wire.state.position.emplace_back(std::min(0.0, at) + radius * std::sin(angle), radius * (1.0 - std::cos(angle)),
                                     0.0);
  }
  wire.state.twist_angle.assign(static_cast<std::size_t>(n), 0.0);
  double energy = 0.0;
  if (curved)
    return wire.energy();
  guide.forEachEdge(wire.rod, wire.state, [&energy](int /*edge*/, const GuidedEdge& term) { energy += term.energy; });
  return energy;
}

// The corner that chords cut is an energy that changes with the position of the nodes, and so a force on the hand.
TEST(CurvedGuide, EnergyDependsFarLessOnThePositionOfTheNodesThanThatOfChords)
{
  const double exact = arcEnergy(0.05e-3, 0.0, false);
  double chords = 0.0;
  double curves = 0.0;
  for (double shift = 0.0; shift < 1.0; shift += 0.1)
  {
    chords = std::max(chords, std::abs(arcEnergy(2e-3, shift, false) - exact));
    curves = std::max(curves, std::abs(arcEnergy(2e-3, shift, true) - exact));
  }
  EXPECT_LT(curves, 0.25 * chords) << chords << ' ' << curves << " of " << exact;
}

}  // namespace
}  // namespace endovascular_sim::rod
