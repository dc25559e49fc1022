#include "benchmark/reference/mixed_statics.h"

#include <algorithm>
#include <cmath>

namespace endovascular_sim::benchmark
{
namespace
{

constexpr double kLeastShift = 1e-4;  // smallest shift over EI/L³
constexpr double kMostShift = 1e12;   // largest shift over EI/L³
constexpr double kShiftGrowth = 30.0;

/** Newton iteration of one mixed rod. */
class Statics
{
public:
  Statics(rod::MixedRod& rod, const StaticsSettings& settings, const rod::TwistBoundary* twist, rod::State& state,
          StaticsReport& report)
    : rod_(rod), settings_(settings), boundary_(twist), state_(state), report_(report)
  {
    double flexibility = 0.0;
    for (const rod::MixedEdge& edge : rod.edges())
      flexibility = std::max(flexibility, edge.flexibility);
    length_ = rod.length();
    unit_ = 1.0 / (flexibility * length_ * length_ * length_);
    shift_ = kLeastShift;
  }

  bool converge(const std::vector<rod::NodalForce>& forces, double share)
  {
    for (int iteration = 0; iteration < settings_.max_iterations; ++iteration)
    {
      assemble(forces, share);
      if (!solve())
        return false;
      const double factor = limit();
      const double motion = move(factor);
      if (factor == 1.0 && motion < settings_.tolerance * length_)
        return true;
    }
    return false;
  }

private:
  void assemble(const std::vector<rod::NodalForce>& forces, double share)
  {
    base_.reset(rod_.size(state_));
    gradient_.assign(static_cast<std::size_t>(base_.size()), 0.0);
    if (boundary_)
      twist_.relax(rod_, *boundary_, state_);
    rod_.assemble(state_, gradient_, base_);
    if (boundary_)
      twist_.assemble(rod_, state_, gradient_, base_);
    for (const rod::NodalForce& load : forces)
      for (int axis = 0; axis < 3; ++axis)
        gradient_[rod_.positionRow(state_, load.node) + axis] -= share * load.force[axis];
  }

  bool solve()
  {
    for (; shift_ < kMostShift; shift_ *= kShiftGrowth)
    {
      matrix_.copyFrom(base_);
      rhs_ = gradient_;
      for (double& value : rhs_)
        value = -value;
      for (int i = state_.first_node; i < rod_.nodes(); ++i)
        for (int axis = 0; axis < 3; ++axis)
          matrix_.at(rod_.positionRow(state_, i) + axis, rod_.positionRow(state_, i) + axis) += shift_ * unit_;
      rod_.prescribeEnds(state_, matrix_, rhs_);
      ++report_.factorisations;
      report_.residual = 0.0;
      for (int i = state_.first_node; i < rod_.nodes(); ++i)
        for (int axis = 0; axis < 3; ++axis)
          report_.residual = std::max(report_.residual, std::abs(rhs_[rod_.positionRow(state_, i) + axis]));
      if (matrix_.factorise() == rod_.negativePivots(state_))
      {
        matrix_.solve(rhs_);
        shift_ = std::max(kLeastShift, shift_ / kShiftGrowth);
        return true;
      }
      ++report_.shifts;
    }
    return false;
  }

  Eigen::Vector3d increment(int row) const { return {rhs_[row], rhs_[row + 1], rhs_[row + 2]}; }

  double limit() const
  {
    double turn = 0.0;
    for (int j = state_.first_node; j + 1 < rod_.nodes(); ++j)
      turn =
          std::max(turn, (increment(rod_.positionRow(state_, j + 1)) - increment(rod_.positionRow(state_, j))).norm() /
                             rod_.edges()[j].length);
    return turn > settings_.max_rotation ? settings_.max_rotation / turn : 1.0;
  }

  double move(double factor)
  {
    double motion = 0.0;
    for (int i = state_.first_node; i < rod_.nodes(); ++i)
    {
      const Eigen::Vector3d step = factor * increment(rod_.positionRow(state_, i));
      state_.position[i] += step;
      state_.moment[i] += factor * increment(rod_.momentRow(state_, i));
      motion = std::max(motion, step.norm());
    }
    for (int j = state_.first_node; j + 1 < rod_.nodes(); ++j)
      state_.tension[j] += factor * rhs_[rod_.tensionRow(state_, j)];
    return motion;
  }

  rod::MixedRod& rod_;
  const StaticsSettings& settings_;
  const rod::TwistBoundary* boundary_;
  rod::MixedTwist twist_;
  rod::State& state_;
  StaticsReport& report_;
  double length_, unit_, shift_;
  rod::MixedRod::Matrix base_, matrix_;
  std::vector<double> gradient_, rhs_;
};

}  // namespace

StaticsReport solveStatics(rod::MixedRod& rod, const std::vector<rod::NodalForce>& forces,
                           const StaticsSettings& settings, rod::State& state, const rod::TwistBoundary* twist)
{
  StaticsReport report;
  Statics statics(rod, settings, twist, state, report);
  const std::vector<rod::MixedEdge> full = rod.edges();
  report.converged = true;
  for (int step = 1; step <= settings.load_steps; ++step)
  {
    const double share = static_cast<double>(step) / settings.load_steps;
    for (int j = 0; j + 1 < rod.nodes(); ++j)
    {
      rod.edge(j) = full[j];
      rod.edge(j).load *= share;
      for (Eigen::Vector3d& curvature : rod.edge(j).rest_curvature)
        curvature *= share;
    }
    report.converged = report.converged && statics.converge(forces, share);
  }
  for (int j = 0; j + 1 < rod.nodes(); ++j)
    rod.edge(j).load = full[j].load;
  return report;
}

}  // namespace endovascular_sim::benchmark
