#include "rod/twist/turn_coupling.h"

#include <algorithm>

#include <Eigen/Geometry>

#include "rod/model/node_curvature.h"

namespace endovascular_sim::rod
{
namespace
{

using Eigen::Matrix3d;
using Eigen::Vector3d;

Matrix3d crossMatrix(const Vector3d& v)
{
  Matrix3d m;
  m << 0.0, -v.z(), v.y(), v.z(), 0.0, -v.x(), -v.y(), v.x(), 0.0;
  return m;
}

/** Second derivatives of moment·κb = 2P/D with P = moment·(e × g) and D = |ē||ḡ| + e·g. */
SurfaceTwist::EdgeStiffness geometricStiffness(const CurvatureBinormal& kb, const Vector3d& moment)
{
  const Vector3d& e = kb.edge;
  const Vector3d& g = kb.next_edge;
  const double inverse = kb.inverse_denominator;
  const double p = moment.dot(e.cross(g));
  const Vector3d pe = g.cross(moment);
  const Vector3d pg = moment.cross(e);
  const double first = 2.0 * inverse * inverse;
  const double second = 4.0 * p * inverse * inverse * inverse;
  SurfaceTwist::EdgeStiffness stiffness;
  stiffness.before = -first * (pe * g.transpose() + g * pe.transpose()) + second * g * g.transpose();
  stiffness.after = -first * (pg * e.transpose() + e * pg.transpose()) + second * e * e.transpose();
  stiffness.across = -2.0 * inverse * crossMatrix(moment) - first * (pe * e.transpose() + g * pg.transpose()) -
                     first * p * Matrix3d::Identity() + second * g * e.transpose();
  return stiffness;
}

/** Stiffness of an edge across itself under compression. */
Matrix3d compression(const Vector3d& edge, double tension)
{
  const double length = edge.norm();
  const Vector3d direction = edge / length;
  return (std::min(0.0, tension) / length) * (Matrix3d::Identity() - direction * direction.transpose());
}

/** Second derivatives of −moment·κb by an edge whose frame carries the moment. */
Matrix3d tiltStiffness(const Vector3d& edge, const Vector3d& moment, const Vector3d& kb)
{
  return (0.5 / edge.squaredNorm()) * (moment * kb.transpose() + kb * moment.transpose());
}

}  // namespace

TurnCoupling::TurnCoupling(const Discretisation& rod, const State& state, int first_curved,
                           const std::vector<Vector3d>& rest, SurfaceTwist& surface)
  : rod_(rod), state_(state), surface_(surface)
{
  const SurfaceTwist::MixedDerivatives none = {Vector3d::Zero(), Vector3d::Zero(), Vector3d::Zero(), Vector3d::Zero()};
  const int n = rod.nodes();
  surface.mixed.assign(static_cast<std::size_t>(n - 1), none);
  surface.stiffness.resize(static_cast<std::size_t>(n));
  for (int i = state.first_node + 1; i + 1 < n; ++i)
  {
    const CurvatureBinormal kb = binormalAt(rod, state, i);
    Vector3d strain = kb.value - state.curvature_offset[i];
    if (i >= first_curved)
      strain -= rest[i];
    SurfaceTwist::EdgeStiffness& stiffness = surface.stiffness[i];
    stiffness = geometricStiffness(kb, (rod.bending_stiffness[i] / rod.cell_length[i]) * strain);
    stiffness.before += compression(kb.edge, state.tension[i - 1]);
    if (i + 2 == n)
      stiffness.after += compression(kb.next_edge, state.tension[i]);
  }
}

void TurnCoupling::addLayer(const Discretisation& layer, const QuasiStaticTwist& twist, int k,
                            const std::vector<int>* owner)
{
  layer_ = k;
  owner_ = owner;
  for (int i = std::max(twist.firstCurved(), state_.first_node + 1); i + 1 < layer.nodes(); ++i)
  {
    addRestCurvature(layer, i, twist);
    if (isUnknown(i - 1) && isUnknown(i))
      addTwist(layer, i);
  }
}

bool TurnCoupling::isUnknown(int edge) const
{
  return surface_.unknown[edge] != 0 && (owner_ == nullptr || (*owner_)[edge] == layer_);
}

void TurnCoupling::addRestCurvature(const Discretisation& layer, int node, const QuasiStaticTwist& twist)
{
  const CurvatureBinormal kb = binormalAt(rod_, state_, node);
  const double bending = layer.bending_stiffness[node] / layer.cell_length[node];
  SurfaceTwist::EdgeStiffness& stiffness = surface_.stiffness[node];
  for (const int edge : {node - 1, node})
  {
    const Vector3d rest = twist.restCurvatureOnEdge(layer, node, edge);
    const Vector3d& along = edge < node ? kb.edge : kb.next_edge;
    (edge < node ? stiffness.before : stiffness.after) -= tiltStiffness(along, bending * rest, kb.value);
    if (!isUnknown(edge))
      continue;
    const Vector3d turned = -bending * along.normalized().cross(rest);
    addMixed(edge, node, kb.transposeBefore(turned), kb.transposeAfter(turned));
  }
}

void TurnCoupling::addTwist(const Discretisation& layer, int node)
{
  const CurvatureBinormal kb = binormalAt(rod_, state_, node);
  const double torsion = layer.torsional_stiffness[node] / layer.cell_length[node];
  const Vector3d before = (0.5 / rod_.rest_length[node - 1]) * kb.value;
  const Vector3d after = (0.5 / rod_.rest_length[node]) * kb.value;
  addMixed(node - 1, node, -torsion * before, -torsion * after);
  addMixed(node, node, torsion * before, torsion * after);
  SurfaceTwist::EdgeStiffness& stiffness = surface_.stiffness[node];
  stiffness.before += torsion * before * before.transpose();
  stiffness.across += torsion * before * after.transpose();
  stiffness.after += torsion * after * after.transpose();
}

/** Adds derivatives by the edges before and after a node to those of an edge's turn. */
void TurnCoupling::addMixed(int edge, int node, const Vector3d& before, const Vector3d& after)
{
  SurfaceTwist::MixedDerivatives& mixed = surface_.mixed[edge];
  const int place = node - edge;  // 0: the edge begins at the node, 1: it ends there
  mixed[place] -= before;
  mixed[place + 1] += before - after;
  mixed[place + 2] += after;
}

}  // namespace endovascular_sim::rod
