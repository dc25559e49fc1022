#include "benchmark/mouth/mouth_reference.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>

#include "rod/boundary/introducer_guide.h"

namespace endovascular_sim::benchmark
{
namespace
{

using Eigen::Matrix3d;
using Eigen::Vector3d;

constexpr double kWallStiffness = 2e8;  // of tube and sheath per length of wire [N/m²]: 5 µm at 1 N/mm
constexpr double kTipLength = 1e-3;     // m, length of wire that the contact of the rounded tip represents
constexpr double kStep = 50e-6;         // m, of the central difference
constexpr double kTolerance = 1e-8;     // of an equilibrium; the error of its energy is of second order
constexpr int kPoints = 8;              // of the midpoint rule on an edge

const rod::Section& sectionAt(const rod::Wire& wire, double from_tip)
{
  double end = 0.0;
  for (auto section = wire.sections.rbegin(); section != wire.sections.rend(); ++section)
  {
    end += section->length;
    if (from_tip < end)
      return *section;
  }
  return wire.sections.front();
}

}  // namespace

int MouthReference::simulatedEdges(double inserted_length) const
{
  return static_cast<int>(std::floor((inserted_length + problem_.guide_length) / problem_.edge)) + 2;
}

/** Potential of the guide (IntroducerGuide), of the sheath and of the tube on a node. */
NodePotential MouthReference::potentialAt(const Vector3d& position, double stiffness, double length, bool tip) const
{
  NodePotential sum;
  const double decay = problem_.guide_decay;
  const double depth = (rod::IntroducerGuide::kReach * decay - position.x()) / decay;
  const Vector3d lateral(0.0, position.y(), position.z());
  if (depth > 0.0)
  {
    const double k = length * stiffness * depth * depth * depth / std::pow(decay, 4);
    const double slope = -3.0 / (decay * depth);
    const double squared = lateral.squaredNorm();
    const Vector3d axis = Vector3d::UnitX();
    sum.energy += 0.5 * k * squared;
    sum.gradient += k * lateral + 0.5 * k * slope * squared * axis;
    sum.hessian += k * (Matrix3d::Identity() - axis * axis.transpose()) +
                   k * slope * (lateral * axis.transpose() + axis * lateral.transpose()) +
                   0.5 * k * (2.0 / 3.0) * slope * slope * squared * axis * axis.transpose();
  }
  addWall(position, tip ? kTipLength : length, sum);
  return sum;
}

/** Walls: ½ k (distance from the axis − clearance)² per length. */
void MouthReference::addWall(const Vector3d& position, double length, NodePotential& sum) const
{
  const bool inside = position.x() < 0.0;
  const double clearance = inside ? problem_.sheath_clearance : problem_.clearance;
  double offset = position.y();
  Vector3d outward = Vector3d::UnitY();
  Matrix3d turning = Matrix3d::Zero();  // derivative of the normal
  if (problem_.bend_curvature != 0.0 && position.x() > problem_.bend_begin)
  {
    const Vector3d centre(problem_.bend_begin, 1.0 / problem_.bend_curvature, 0.0);
    const Vector3d from = position - centre;
    const double distance = std::hypot(from.x(), from.y());
    offset = 1.0 / problem_.bend_curvature - distance;
    outward = Vector3d(-from.x() / distance, -from.y() / distance, 0.0);
    const Vector3d along(outward.y(), -outward.x(), 0.0);
    turning = -along * along.transpose() / distance;
  }
  const double excess = std::abs(offset) - clearance;
  if (excess > 0.0)
  {
    const double sign = offset > 0.0 ? 1.0 : -1.0;
    const double k = kWallStiffness * length;
    sum.energy += 0.5 * k * excess * excess;
    sum.gradient += k * excess * sign * outward;
    sum.hessian += k * (outward * outward.transpose() + excess * sign * turning);
  }
  sum.hessian(2, 2) += kWallStiffness * length;  // the problem is plane
  sum.gradient.z() += kWallStiffness * length * position.z();
}

/** Rod from the first edge before the guide to the tip. */
EquilibriumProblem MouthReference::problemAt(double inserted_length) const
{
  EquilibriumProblem problem;
  const int n = edges_ + 1;
  const double h = problem_.edge;
  rod::Section section = problem_.wire.sections.back();
  section.length = edges_ * h;
  section.rest_curvature.setZero();
  rod::Wire straight;
  straight.sections = {section};
  problem.rod = rod::discretiseUniformly(straight, n);
  problem.rest_binormal.assign(static_cast<std::size_t>(n), Vector3d::Zero());
  std::vector<double> stiffness(static_cast<std::size_t>(n));
  for (int i = 0; i < n; ++i)
  {
    double angle = 0.0;
    double compliance = 0.0;
    for (int q = 0; q < kPoints; ++q)
    {
      const double from_tip = (n - 1 - i) * h + h * ((q + 0.5) / kPoints - 0.5);
      const rod::Section& at = sectionAt(problem_.wire, std::max(0.0, from_tip));
      const double beyond = (inserted_length - from_tip) / problem_.guide_decay;  // ±½: the mouth's transition
      angle -= at.rest_curvature.y() * std::clamp(0.5 + beyond, 0.0, 1.0) * h / kPoints;
      compliance += 1.0 / (kPoints * at.bending_stiffness);
    }
    stiffness[i] = problem.rod.bending_stiffness[i] = 1.0 / compliance;
    problem.rest_binormal[i] = Vector3d(0.0, 0.0, 2.0 * std::tan(0.5 * angle));
  }
  problem.tolerance = kTolerance;
  problem.held.assign(static_cast<std::size_t>(n), false);
  problem.held[0] = problem.held[1] = true;
  problem.node_potential = [this, stiffness, h, n](int node, const Vector3d& position)
  { return potentialAt(position, stiffness[node], node + 1 < n ? h : 0.5 * h, node + 1 == n); };
  return problem;
}

/** Point of the last equilibrium at a number of edges from the tip, negative beyond it: the wire slides along itself.
 */
Vector3d MouthReference::slid(double edges, const Vector3d& straight) const
{
  if (edges <= 0.0)
    return last_[0] - edges * (last_[0] - last_[1]);
  const auto before = static_cast<std::size_t>(edges);
  if (before + 1 >= last_.size())
    return straight;
  const double share = edges - static_cast<double>(before);
  return (1.0 - share) * last_[before] + share * last_[before + 1];
}

/** Energy of the equilibrium, with that of the part that is held straight [J]. */
double MouthReference::leastEnergy(double inserted_length)
{
  const int n = edges_ + 1;
  const double h = problem_.edge;
  Equilibrium e;
  for (int i = 0; i < n; ++i)
  {
    const int from_tip = n - 1 - i;
    e.position.emplace_back(inserted_length - from_tip * h, 0.0, 0.0);
    if (i > 1 && !last_.empty())
      e.position.back() = slid(from_tip - (inserted_length - last_insertion_) / h, e.position.back());
  }
  const EquilibriumSolver solver(problemAt(inserted_length));
  if (!solver.solve(e))
    throw std::runtime_error("mouth: no equilibrium at " + std::to_string(1e3 * inserted_length) + " mm");
  last_.assign(e.position.rbegin(), e.position.rend());
  last_insertion_ = inserted_length;
  double energy = solver.potential(e);
  double total = 0.0;
  for (const rod::Section& section : problem_.wire.sections)
    total += section.length;
  const int points = static_cast<int>(total / h * kPoints);
  for (int q = 0; q < points; ++q)
  {
    const double from_tip = (q + 0.5) * h / kPoints;
    const rod::Section& at = sectionAt(problem_.wire, from_tip);
    const double acting = std::clamp(0.5 + (inserted_length - from_tip) / problem_.guide_decay, 0.0, 1.0);
    energy += 0.5 * at.bending_stiffness * at.rest_curvature.squaredNorm() * (1.0 - acting) * h / kPoints;
  }
  return energy;
}

double MouthReference::force(double inserted_length)
{
  edges_ = simulatedEdges(inserted_length - kStep);
  const double before = leastEnergy(inserted_length - kStep);
  return (leastEnergy(inserted_length + kStep) - before) / (2.0 * kStep);
}

}  // namespace endovascular_sim::benchmark
