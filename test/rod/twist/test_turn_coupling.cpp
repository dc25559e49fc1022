#include <cmath>

#include <gtest/gtest.h>

#include "benchmark/reference/bending_exact_hessian.h"
#include "rod/energy/potential_energy.h"
#include "rod/model/node_curvature.h"
#include "rod/twist/bishop_frames.h"
#include "rod/twist/turn_coupling.h"
#include "test/rod/rod_fixtures.h"

namespace endovascular_sim::rod
{
namespace
{

/** A bent wire with a curved tip and its model of the twist, without torque. */
struct BentTip
{
  Discretisation rod = discretiseUniformly(curvedTipWire(80.0), 25);
  State state;
  TwistBoundary boundary;
  BishopFrames frames;
  SurfaceTwist surface;

  BentTip()
  {
    const auto n = static_cast<std::size_t>(rod.nodes());
    state.position.resize(n);
    state.curvature_offset.assign(n, Eigen::Vector3d::Zero());
    state.tension.assign(n - 1, 0.0);
    state.twist_angle.assign(n - 1, 0.4);
    for (int i = 1; i < rod.nodes(); ++i)
    {
      const double a = 0.06 * i + 0.02 * std::sin(0.7 * i);
      const double b = 0.3 * std::sin(0.2 * i);
      state.position[i] =
          state.position[i - 1] +
          rod.rest_length[i - 1] * Eigen::Vector3d(std::cos(a) * std::cos(b), std::sin(a) * std::cos(b), std::sin(b));
    }
    boundary.rotation = 0.4;
    frames.transport(rod, boundary, state);
    QuasiStaticTwist twist;
    twist.evaluateAt(rod, boundary, state);
    surface.reset(n - 1);
    for (int j = twist.firstUnknown(); j + 1 < rod.nodes(); ++j)
      surface.unknown[j] = 1;
    TurnCoupling(rod, state, twist.firstCurved(), twist.restCurvatureBinormals(), surface)
        .addLayer(rod, twist, 0, nullptr);
  }

  /** Energy after a motion of the nodes, while the material follows the edges, and turns of the edges. */
  double energy(const std::vector<Eigen::Vector3d>& motion, const std::vector<double>& turn) const
  {
    State moved = state;
    for (std::size_t i = 0; i < motion.size(); ++i)
      moved.position[i] += motion[i];
    BishopFrames now;
    now.transport(rod, boundary, moved);
    for (std::size_t j = 0; j < turn.size(); ++j)
      moved.twist_angle[j] += turn[j] - now.turnSince(frames, static_cast<int>(j));
    PotentialEnergy energy;
    addElasticEnergy(rod, boundary, moved, moved.twist_angle, energy);
    return energy.bending + energy.twist;
  }
};

TEST(TurnCoupling, MixedDerivativesAreThoseOfTheEnergy)
{
  const BentTip tip;
  const int n = tip.rod.nodes();
  const double step = 2e-6;  // m
  const double angle = 2e-3;
  std::vector<Eigen::Vector3d> motion(static_cast<std::size_t>(n), Eigen::Vector3d::Zero());
  std::vector<double> turn(static_cast<std::size_t>(n - 1), 0.0);
  double largest = 0.0;
  const int first = tip.rod.first_curved;  // before it, the straight body is a spring without a holonomy of its own
  for (int j = first; j + 1 < n; ++j)
    for (const Eigen::Vector3d& mixed : tip.surface.mixed[j])
      largest = std::max(largest, mixed.norm());
  for (int j = first; j + 1 < n; ++j)
    for (int place = 0; place < 4; ++place)
      for (int axis = 0; axis < 3; ++axis)
      {
        const int node = j - 1 + place;
        if (node >= n)
          continue;
        double sum = 0.0;
        for (const double x : {-1.0, 1.0})
          for (const double t : {-1.0, 1.0})
          {
            motion[node][axis] = x * step;
            turn[j] = t * angle;
            sum += x * t * tip.energy(motion, turn);
          }
        motion[node][axis] = turn[j] = 0.0;
        EXPECT_NEAR(tip.surface.mixed[j][place][axis], sum / (4.0 * step * angle), 2e-4 * largest) << j << ' ' << place;
      }
}

/** Second derivative along a motion of the nodes: Gauss–Newton form and coupling. */
double stiffnessAlong(const BentTip& tip, const std::vector<Eigen::Vector3d>& motion)
{
  double sum = 0.0;
  for (int i = 1; i + 1 < tip.rod.nodes(); ++i)
  {
    const Eigen::Vector3d e = motion[i] - motion[i - 1];
    const Eigen::Vector3d g = motion[i + 1] - motion[i];
    const BendingHessian gauss_newton(binormalAt(tip.rod, tip.state, i),
                                      tip.rod.bending_stiffness[i] / tip.rod.cell_length[i]);
    const SurfaceTwist::EdgeStiffness& further = tip.surface.stiffness[i];
    sum += e.dot((gauss_newton.before_before + further.before) * e) +
           2.0 * e.dot((gauss_newton.before_after + further.across) * g) +
           g.dot((gauss_newton.after_after + further.after) * g);
  }
  return sum;
}

TEST(TurnCoupling, StiffnessOfTheCentrelineIsTheSecondDerivativeOfTheEnergy)
{
  const BentTip tip;
  const int n = tip.rod.nodes();
  const std::vector<double> none(static_cast<std::size_t>(n - 1), 0.0);
  for (int trial = 0; trial < 6; ++trial)
  {
    std::vector<Eigen::Vector3d> motion(static_cast<std::size_t>(n), Eigen::Vector3d::Zero());
    for (int i = tip.rod.first_curved + 1; i < n; ++i)
      motion[i] = Eigen::Vector3d(std::sin(1.0 + i * trial), std::cos(2.0 * i + trial), std::sin(3.0 * i - trial));
    const double step = 2e-6;
    const auto at = [&](double share)
    {
      std::vector<Eigen::Vector3d> moved = motion;
      for (Eigen::Vector3d& one : moved)
        one *= share * step;
      return tip.energy(moved, none);
    };
    const double difference = (at(1.0) - 2.0 * at(0.0) + at(-1.0)) / (step * step);
    EXPECT_NEAR(stiffnessAlong(tip, motion), difference, 2e-4 * std::abs(difference)) << trial;
  }
}

// The same second derivative in another form, by another author: benchmark/reference.
TEST(TurnCoupling, StiffnessOfANodeWithoutRestCurvatureIsThatOfTheReference)
{
  const BentTip tip;
  const int i = 5;
  const CurvatureBinormal kb = binormalAt(tip.rod, tip.state, i);
  const double bending = tip.rod.bending_stiffness[i] / tip.rod.cell_length[i];
  const benchmark::BendingExactHessian exact(kb, Eigen::Vector3d::Zero(), bending);
  const BendingHessian gauss_newton(kb, bending);
  const SurfaceTwist::EdgeStiffness& further = tip.surface.stiffness[i];
  const double scale = exact.before_before.norm();
  EXPECT_LT((gauss_newton.before_before + further.before - exact.before_before).norm(), 1e-12 * scale);
  EXPECT_LT((gauss_newton.before_after + further.across - exact.before_after).norm(), 1e-12 * scale);
  EXPECT_LT((gauss_newton.after_after + further.after - exact.after_after).norm(), 1e-12 * scale);
}

}  // namespace
}  // namespace endovascular_sim::rod
