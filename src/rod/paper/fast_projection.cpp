#include "rod/paper/fast_projection.h"

#include <algorithm>
#include <cmath>

namespace endovascular_sim::rod
{
namespace
{

constexpr int kMaxIterations = 40;

}  // namespace

bool FastProjection::project(const Discretisation& rod, int first, const std::vector<double>& inverse_mass,
                             double tolerance, std::vector<Eigen::Vector3d>& position)
{
  const int last = rod.nodes() - 2;
  edge_.resize(rod.rest_length.size());
  constraint_.resize(rod.rest_length.size());
  diagonal_.resize(rod.rest_length.size());
  tension_.assign(rod.rest_length.size(), 0.0);
  for (iterations_ = 0; iterations_ < kMaxIterations; ++iterations_)
  {
    const double strain = residual(rod, first, inverse_mass, position);
    // At least once: a strain within the tolerance, left to the stretch energy, would make the tension oscillate.
    if (strain <= tolerance && iterations_ > 0)
      return true;
    if (!std::isfinite(strain) || !solve(first, last, inverse_mass))
      return false;
    for (int j = first; j <= last; ++j)
    {
      const Eigen::Vector3d impulse = (2.0 * constraint_[j]) * edge_[j];
      position[j] += inverse_mass[j] * impulse;
      position[j + 1] -= inverse_mass[j + 1] * impulse;
      tension_[j] += 2.0 * edge_[j].norm() * constraint_[j];
    }
  }
  return residual(rod, first, inverse_mass, position) <= tolerance;
}

/** Computes edges and constraints.
 *  @return the largest strain of an edge that can move */
double FastProjection::residual(const Discretisation& rod, int first, const std::vector<double>& inverse_mass,
                                const std::vector<Eigen::Vector3d>& position)
{
  double worst = 0.0;
  for (int j = first; j + 1 < rod.nodes(); ++j)
  {
    edge_[j] = position[j + 1] - position[j];
    const double rest = rod.rest_length[j];
    const bool movable = inverse_mass[j] + inverse_mass[j + 1] > 0.0;
    constraint_[j] = movable ? edge_[j].squaredNorm() - rest * rest : 0.0;
    const double strain = movable ? std::abs(edge_[j].norm() / rest - 1.0) : 0.0;
    worst = strain > worst || std::isnan(strain) ? strain : worst;
  }
  return worst;
}

/** Solves by tridiagonal LDLᵀ; the multipliers, times Δt², replace the constraints. */
bool FastProjection::solve(int first, int last, const std::vector<double>& inverse_mass)
{
  for (int j = first; j <= last; ++j)
  {
    const double weight = inverse_mass[j] + inverse_mass[j + 1];
    diagonal_[j] = weight > 0.0 ? 4.0 * weight * edge_[j].squaredNorm() : 1.0;
    if (j == first)
      continue;
    const double factor = -4.0 * inverse_mass[j] * edge_[j - 1].dot(edge_[j]) / diagonal_[j - 1];
    diagonal_[j] -= factor * factor * diagonal_[j - 1];
    constraint_[j] -= factor * constraint_[j - 1];
    if (!(diagonal_[j] > 0.0))
      return false;
  }
  for (int j = last; j >= first; --j)
  {
    const double above = j < last ? -4.0 * inverse_mass[j + 1] * edge_[j].dot(edge_[j + 1]) * constraint_[j + 1] : 0.0;
    constraint_[j] = (constraint_[j] - above) / diagonal_[j];
  }
  return true;
}

}  // namespace endovascular_sim::rod
