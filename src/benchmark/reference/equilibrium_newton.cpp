#include <algorithm>
#include <cmath>

#include <Eigen/Eigenvalues>
#include <Eigen/QR>

#include "benchmark/reference/equilibrium.h"

// Newton's method on the saddle-point system of nodes, tensions, reactions and torque; stability of the solution.

namespace endovascular_sim::benchmark
{
namespace
{

constexpr int kMaxIterations = 500;
constexpr double kLargestTurn = 0.3;  // largest rotation of an edge in one iteration [rad]
constexpr double kConvergedStrain = 1e-12;
constexpr double kReach =
    0.1;  // largest motion by the residual force against the regularisation, over the length of the wire

}  // namespace

/** Residuals of all equations, zero at fixed nodes. */
Eigen::VectorXd EquilibriumSolver::residual(const Equilibrium& e) const
{
  const int n = problem_.nodes();
  Eigen::VectorXd r = Eigen::VectorXd::Zero(unknowns());
  r.head(rowOf(n)) = forces(e);
  int row = 3 * n;
  for (int j = 0; j < problem_.edges(); ++j, ++row)
    r[row] = rigidEdge(j) ? 0.0 : edge(e, j).length - problem_.rod.rest_length[j];
  for (std::size_t k = 0; k < problem_.supports.size(); ++k)
    r.segment<3>(rowOf(problem_.supports[k].node)) -= e.reaction[k] * problem_.supports[k].direction;
  for (int i = 0; i < n; ++i)
    if (problem_.held[i])
      r.segment<3>(rowOf(i)).setZero();
  r[unknowns() - 1] = problem_.twist_held ? problem_.twist + transport(e) - compliance_ * e.torque : 0.0;
  return r;
}

/** Adds the rows of edges, supports and torque, and their transposes. */
void EquilibriumSolver::addConstraints(const Equilibrium& e, Triplets& entries) const
{
  const auto couple = [this, &entries](int row, int node, const Eigen::Vector3d& value)
  {
    for (int axis = 0; axis < 3 && !problem_.held[node]; ++axis)
    {
      entries.emplace_back(row, 3 * node + axis, value[axis]);
      entries.emplace_back(3 * node + axis, row, value[axis]);
    }
  };
  int row = 3 * problem_.nodes();
  for (int j = 0; j < problem_.edges(); ++j, ++row)
  {
    if (rigidEdge(j))
    {
      entries.emplace_back(row, row, 1.0);
      continue;
    }
    const Eigen::Vector3d direction = edge(e, j).vector.normalized();
    couple(row, j, -direction);
    couple(row, next(j), direction);
  }
  for (const Support& support : problem_.supports)
    couple(row++, support.node, -support.direction);
  if (problem_.twist_held)
  {
    const Eigen::VectorXd gradient = transportGradient(e);
    for (int i = 0; i < problem_.nodes(); ++i)
      couple(row, i, gradient.segment<3>(rowOf(i)));
  }
  entries.emplace_back(row, row, problem_.twist_held ? -compliance_ : 1.0);
}

rod::SparseMatrix EquilibriumSolver::saddle(const Equilibrium& e, double shift) const
{
  Triplets entries;
  const rod::SparseMatrix second = hessian(e);
  for (int col = 0; col < second.cols(); ++col)
    for (rod::SparseMatrix::InnerIterator it(second, col); it; ++it)
      if (!problem_.held[it.row() / 3] && !problem_.held[col / 3])
        entries.emplace_back(static_cast<int>(it.row()), col, it.value());
  for (int k = 0; k < 3 * problem_.nodes(); ++k)
    entries.emplace_back(k, k, problem_.held[k / 3] ? 1.0 : shift);
  addConstraints(e, entries);
  rod::SparseMatrix matrix(unknowns(), unknowns());
  matrix.setFromTriplets(entries.begin(), entries.end());
  return matrix;
}

void EquilibriumSolver::advance(Equilibrium& e, const Eigen::VectorXd& step) const
{
  const int n = problem_.nodes();
  for (int i = 0; i < n; ++i)
    if (!problem_.held[i])
      e.position[i] += step.segment<3>(rowOf(i));
  for (int j = 0; j < problem_.edges(); ++j)
    e.tension[j] += step[3 * n + j];
  for (std::size_t k = 0; k < problem_.supports.size(); ++k)
    e.reaction[k] += step[3 * n + problem_.edges() + static_cast<int>(k)];
  e.torque += step[unknowns() - 1];
  e.transport = transport(e);
}

bool EquilibriumSolver::solve(Equilibrium& e) const
{
  const int n = problem_.nodes();
  e.tension.resize(static_cast<std::size_t>(problem_.edges()), 0.0);
  e.reaction.resize(problem_.supports.size(), 0.0);
  e.transport = transport(e);
  rod::KluSolver klu;
  for (e.iterations = 1; e.iterations <= kMaxIterations; ++e.iterations)
  {
    const Eigen::VectorXd r = residual(e);
    const double shift = r.head(rowOf(n)).lpNorm<Eigen::Infinity>() / (kReach * length_);
    if (!r.allFinite() || !klu.factorise(saddle(e, shift)))
      return false;
    Eigen::VectorXd step = -r;
    klu.solve(step.data());
    double turn = 0.0;
    for (int j = 0; j < problem_.edges(); ++j)
      turn = std::max(
          turn, (step.segment<3>(rowOf(next(j))) - step.segment<3>(rowOf(j))).norm() / problem_.rod.rest_length[j]);
    const double factor = std::min(1.0, kLargestTurn / turn);
    advance(e, factor * step);
    double strain = 0.0;
    for (int j = 0; j < problem_.edges(); ++j)
      strain = std::max(strain, rigidEdge(j) ? 0.0 : std::abs(edge(e, j).length / problem_.rod.rest_length[j] - 1.0));
    if (step.head(rowOf(n)).lpNorm<Eigen::Infinity>() < problem_.tolerance * length_ && strain < kConvergedStrain)
      return true;
  }
  return false;
}

/** Rows of the active edges and supports; fixed nodes count as single coordinates. */
Eigen::MatrixXd EquilibriumSolver::constraintJacobian(const Equilibrium& e) const
{
  const int n = problem_.nodes();
  const Eigen::Index most = rowOf(n) + problem_.edges() + static_cast<int>(problem_.supports.size());
  Eigen::MatrixXd jacobian = Eigen::MatrixXd::Zero(most, rowOf(n));
  int rows = 0;
  for (int i = 0; i < n; ++i)
    if (problem_.held[i])
    {
      jacobian.block<3, 3>(rows, rowOf(i)).setIdentity();
      rows += 3;
    }
  for (int j = 0; j < problem_.edges(); ++j)
    if (!rigidEdge(j))
    {
      const Eigen::RowVector3d direction = edge(e, j).vector.normalized().transpose();
      jacobian.block<1, 3>(rows, rowOf(j)) = -direction;
      jacobian.block<1, 3>(rows++, rowOf(next(j))) = direction;
    }
  for (const Support& support : problem_.supports)
    jacobian.block<1, 3>(rows++, rowOf(support.node)) = support.direction.transpose();
  return jacobian.topRows(rows);
}

Eigen::VectorXd EquilibriumSolver::stiffness(const Equilibrium& e) const
{
  const Eigen::MatrixXd jacobian = constraintJacobian(e);
  const Eigen::ColPivHouseholderQR<Eigen::MatrixXd> qr(jacobian.transpose());
  const Eigen::MatrixXd q = qr.householderQ();
  const Eigen::MatrixXd tangent = q.rightCols(jacobian.cols() - qr.rank());
  const Eigen::VectorXd gradient = transportGradient(e);
  Eigen::MatrixXd second = Eigen::MatrixXd(hessian(e));
  second += gradient * gradient.transpose() / compliance_;
  const Eigen::MatrixXd reduced = tangent.transpose() * second * tangent;
  return Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(reduced, Eigen::EigenvaluesOnly).eigenvalues();
}

}  // namespace endovascular_sim::benchmark
