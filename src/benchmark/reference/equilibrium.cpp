#include "benchmark/reference/equilibrium.h"

#include <algorithm>
#include <cmath>

#include "benchmark/reference/bending_exact_hessian.h"
#include "benchmark/reference/twist_of_centreline.h"
#include "common/error.h"
#include "rod/model/stretching.h"

namespace endovascular_sim::benchmark
{
namespace
{

void addBlock(std::vector<Eigen::Triplet<double>>& entries, int row_node, int col_node, const Eigen::Matrix3d& block)
{
  for (int row = 0; row < 3; ++row)
    for (int col = 0; col < 3; ++col)
      entries.emplace_back(3 * row_node + row, 3 * col_node + col, block(row, col));
}

/** Adds a Hessian with respect to the edges before and after a node as one with respect to the three nodes. */
void addStencil(std::vector<Eigen::Triplet<double>>& entries, const int (&node)[3], const Eigen::Matrix3d& a,
                const Eigen::Matrix3d& b, const Eigen::Matrix3d& c)
{
  addBlock(entries, node[0], node[0], a);
  addBlock(entries, node[0], node[1], b - a);
  addBlock(entries, node[0], node[2], -b);
  addBlock(entries, node[1], node[0], b.transpose() - a);
  addBlock(entries, node[1], node[1], a - b - b.transpose() + c);
  addBlock(entries, node[1], node[2], b - c);
  addBlock(entries, node[2], node[0], -b.transpose());
  addBlock(entries, node[2], node[1], b.transpose() - c);
  addBlock(entries, node[2], node[2], c);
}

}  // namespace

rod::Discretisation discretiseRing(const rod::Section& section, int nodes)
{
  rod::Wire wire;
  wire.sections = {section};
  rod::Discretisation ring = rod::discretiseUniformly(wire, nodes + 1);
  ring.position.pop_back();
  for (std::vector<double>* values : {&ring.cell_length, &ring.bending_stiffness, &ring.torsional_stiffness, &ring.mass,
                                      &ring.radius, &ring.friction})
    values->pop_back();
  ring.rest_curvature.pop_back();
  // The cell of the first node is complete, unlike at the end of an open rod.
  ring.cell_length.front() = ring.rest_length.front();
  ring.mass.front() *= 2.0;
  ring.first_curved = std::min(ring.first_curved, nodes);
  return ring;
}

EquilibriumSolver::EquilibriumSolver(EquilibriumProblem problem) : problem_(std::move(problem))
{
  const auto n = static_cast<std::size_t>(problem_.nodes());
  if (n < 3 || (!problem_.closed() && problem_.edges() != problem_.nodes() - 1))
    throw InputError("equilibrium", "rod", "requires at least three nodes, and an edge between neighbours");
  problem_.held.resize(n, false);
  if (!(problem_.force.empty() || problem_.force.size() == n) ||
      !(problem_.rest_binormal.empty() || problem_.rest_binormal.size() == n))
    throw InputError("equilibrium", "force, rest_binormal", "must be empty or have one entry per node");
  if (problem_.twist_held && !problem_.closed() && !(rigidEdge(0) && rigidEdge(problem_.edges() - 1)))
    throw InputError("equilibrium", "twist_held", "requires both end edges fixed, or a ring");
  for (int i = firstBent(); i <= lastBent(); ++i)
    compliance_ += problem_.rod.cell_length[i] / problem_.rod.torsional_stiffness[i];
  for (const double rest : problem_.rod.rest_length)
    length_ += rest;
}

int EquilibriumSolver::unknowns() const
{
  return 3 * problem_.nodes() + problem_.edges() + static_cast<int>(problem_.supports.size()) + 1;
}

EquilibriumSolver::Edge EquilibriumSolver::edge(const Equilibrium& e, int index) const
{
  const Eigen::Vector3d vector = e.position[next(index)] - e.position[index];
  return {vector, vector.norm()};
}

Eigen::Vector3d EquilibriumSolver::restBinormal(int node) const
{
  return problem_.rest_binormal.empty() ? Eigen::Vector3d(Eigen::Vector3d::Zero()) : problem_.rest_binormal[node];
}

double EquilibriumSolver::transport(const Equilibrium& e) const
{
  if (!problem_.twist_held)
    return 0.0;
  const Eigen::Vector3d first = edge(e, 0).vector.normalized();
  const Eigen::Vector3d start = first.unitOrthogonal();
  Eigen::Vector3d tangent = first;
  Eigen::Vector3d director = start;
  const int last = problem_.closed() ? problem_.edges() : problem_.edges() - 1;
  for (int j = 1; j <= last; ++j)
  {
    const Eigen::Vector3d along = edge(e, j % problem_.edges()).vector.normalized();
    director = parallelTransport(director, tangent, along);
    tangent = along;
  }
  const Eigen::Vector3d held = parallelTransport(start, first, tangent);
  const double angle = std::atan2(director.cross(held).dot(tangent), director.dot(held));
  return angle + 2.0 * M_PI * std::round((e.transport - angle) / (2.0 * M_PI));
}

double EquilibriumSolver::potential(const Equilibrium& e) const
{
  double sum = 0.0;
  for (int i = firstBent(); i <= lastBent(); ++i)
  {
    const int before = edgeBefore(i);
    const rod::CurvatureBinormal kb(edge(e, before).vector, edge(e, i).vector,
                                    problem_.rod.rest_length[before] * problem_.rod.rest_length[i]);
    sum += bendingEnergy(kb, restBinormal(i), problem_.rod.bending_stiffness[i] / problem_.rod.cell_length[i]);
  }
  for (std::size_t i = 0; i < problem_.force.size(); ++i)
    sum -= problem_.force[i].dot(e.position[i]);
  for (int i = 0; problem_.node_potential && i < problem_.nodes(); ++i)
    sum += problem_.node_potential(i, e.position[i]).energy;
  if (problem_.twist_held)
  {
    const double twist = problem_.twist + transport(e);
    sum += 0.5 * twist * twist / compliance_;
  }
  return sum;
}

Eigen::VectorXd EquilibriumSolver::transportGradient(const Equilibrium& e) const
{
  Eigen::VectorXd gradient = Eigen::VectorXd::Zero(rowOf(problem_.nodes()));
  for (int i = firstBent(); problem_.twist_held && i <= lastBent(); ++i)
  {
    const TwistOfCentreline twist(edge(e, edgeBefore(i)).vector, edge(e, i).vector);
    gradient.segment<3>(rowOf(previous(i))) -= twist.by_before;
    gradient.segment<3>(rowOf(i)) += twist.by_before - twist.by_after;
    gradient.segment<3>(rowOf(next(i))) += twist.by_after;
  }
  return gradient;
}

Eigen::VectorXd EquilibriumSolver::forces(const Equilibrium& e) const
{
  Eigen::VectorXd gradient = Eigen::VectorXd::Zero(rowOf(problem_.nodes()));
  for (int i = firstBent(); i <= lastBent(); ++i)
  {
    const int before = edgeBefore(i);
    const rod::CurvatureBinormal kb(edge(e, before).vector, edge(e, i).vector,
                                    problem_.rod.rest_length[before] * problem_.rod.rest_length[i]);
    const Eigen::Vector3d strain =
        problem_.rod.bending_stiffness[i] / problem_.rod.cell_length[i] * (kb.value - restBinormal(i));
    const Eigen::Vector3d by_before = kb.transposeBefore(strain);
    const Eigen::Vector3d by_after = kb.transposeAfter(strain);
    gradient.segment<3>(rowOf(previous(i))) -= by_before;
    gradient.segment<3>(rowOf(i)) += by_before - by_after;
    gradient.segment<3>(rowOf(next(i))) += by_after;
  }
  for (int j = 0; j < problem_.edges(); ++j)
  {
    const Eigen::Vector3d pull = e.tension[j] * edge(e, j).vector.normalized();
    gradient.segment<3>(rowOf(j)) -= pull;
    gradient.segment<3>(rowOf(next(j))) += pull;
  }
  for (std::size_t i = 0; i < problem_.force.size(); ++i)
    gradient.segment<3>(rowOf(static_cast<int>(i))) -= problem_.force[i];
  for (int i = 0; problem_.node_potential && i < problem_.nodes(); ++i)
    gradient.segment<3>(rowOf(i)) += problem_.node_potential(i, e.position[i]).gradient;
  return gradient + e.torque * transportGradient(e);
}

rod::SparseMatrix EquilibriumSolver::hessian(const Equilibrium& e) const
{
  Triplets entries;
  for (int i = firstBent(); i <= lastBent(); ++i)
  {
    const int before = edgeBefore(i);
    const int node[3] = {previous(i), i, next(i)};
    const Eigen::Vector3d in = edge(e, before).vector;
    const Eigen::Vector3d out = edge(e, i).vector;
    const rod::CurvatureBinormal kb(in, out, problem_.rod.rest_length[before] * problem_.rod.rest_length[i]);
    const BendingExactHessian bending(kb, restBinormal(i),
                                      problem_.rod.bending_stiffness[i] / problem_.rod.cell_length[i]);
    addStencil(entries, node, bending.before_before, bending.before_after, bending.after_after);
    if (e.torque == 0.0)
      continue;
    const TwistOfCentreline twist(in, out);
    addStencil(entries, node, e.torque * twist.before_before, e.torque * twist.before_after,
               e.torque * twist.after_after);
  }
  for (int j = 0; j < problem_.edges(); ++j)
  {
    const rod::Stretching stretch(edge(e, j).vector, problem_.rod.rest_length[j], 0.0);
    const Eigen::Matrix3d geometric = stretch.geometric(e.tension[j]);
    addBlock(entries, j, j, geometric);
    addBlock(entries, j, next(j), -geometric);
    addBlock(entries, next(j), j, -geometric);
    addBlock(entries, next(j), next(j), geometric);
  }
  for (int i = 0; problem_.node_potential && i < problem_.nodes(); ++i)
    addBlock(entries, i, i, problem_.node_potential(i, e.position[i]).hessian);
  rod::SparseMatrix matrix(rowOf(problem_.nodes()), rowOf(problem_.nodes()));
  matrix.setFromTriplets(entries.begin(), entries.end());
  return matrix;
}

}  // namespace endovascular_sim::benchmark
