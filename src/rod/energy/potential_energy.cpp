#include "rod/energy/potential_energy.h"

#include <algorithm>
#include <cmath>

#include <Eigen/Geometry>

#include "rod/model/node_curvature.h"
#include "rod/twist/transported_frame.h"

namespace endovascular_sim::rod
{
namespace
{

constexpr double kMinLength = 1e-9;  // least length of the spring at the hold, in edges

double edgeMiddle(const Discretisation& rod, int edge)
{
  return 0.5 * (rod.position[edge] + rod.position[edge + 1]);
}

/** First edge that the hold of the twist does not turn. */
int firstTwistedEdge(const Discretisation& rod, const TwistBoundary& hold)
{
  int edge = 0;
  while (edge + 2 < rod.nodes() && edgeMiddle(rod, edge) < hold.position)
    ++edge;
  return edge;
}

double twistEnergy(const Discretisation& rod, const TwistBoundary& hold, int first, const std::vector<double>& angle)
{
  double energy = 0.0;
  if (hold.held)
  {
    const double length = std::max(edgeMiddle(rod, first) - hold.position, kMinLength * rod.rest_length[first]);
    const double turn = angle[first] - hold.rotation;
    energy += 0.5 * rod.torsional_stiffness[first] / length * turn * turn;
  }
  for (int i = first + 1; i + 1 < rod.nodes(); ++i)
  {
    const double turn = angle[i] - angle[i - 1];
    energy += 0.5 * rod.torsional_stiffness[i] / rod.cell_length[i] * turn * turn;
  }
  return energy;
}

/** Half of a node's rest curvature binormal in a frame that is turned by an angle. */
Eigen::Vector3d halfBinormal(const TransportedFrame& frame, const Eigen::Vector2d& rest, double angle)
{
  const auto [m1, m2] = frame.materialAxes(angle);
  return 0.5 * (rest.x() * m2 - rest.y() * m1);
}

/** First edge with a material frame: that before the first node with rest curvature, or the first one beyond the hold.
 */
int firstFrame(const Discretisation& rod, const TwistBoundary& hold, int first)
{
  int node = first + 1;
  if (hold.hasMouth())
    for (node = 1; node + 1 < rod.nodes() && rod.position[node + 1] <= hold.mouth().begin();)
      ++node;
  return std::clamp(std::max(rod.first_curved, node) - 1, 0, first);
}

/** Strain energy, counted from the rest shape. Before the mouth of an introducer, the wire is held straight. */
double bendingEnergy(const Discretisation& rod, const TwistBoundary& hold, int first, const State& state,
                     const std::vector<double>& angle)
{
  double energy = hold.hasMouth() ? straightEnergy(rod.curved_parts, hold.mouth()) : 0.0;
  const int begin = firstFrame(rod, hold, first);
  TransportedFrame before{hold.tangent, hold.director};
  const auto direction = [&state](int edge) { return (state.position[edge + 1] - state.position[edge]).normalized(); };
  if (begin == 0)
    before.moveTo(direction(0));
  for (int i = 1; i + 1 < rod.nodes(); ++i)
  {
    const Eigen::Vector3d strain = binormalAt(rod, state, i).value - state.curvature_offset[i];
    TransportedFrame after = before;
    if (i >= begin)
      after.moveTo(direction(i));
    double from_rest = 0.0;  // change of the square by the rest curvature
    if (i > begin && i >= rod.first_curved)
    {
      const Eigen::Vector2d rest = hold.hasMouth() && rod.position[i - 1] < hold.mouth().end()
                                       ? rod.restAt(i, hold.mouth()).curvature
                                       : rod.rest_curvature[i];
      from_rest = rest.squaredNorm();
      const Eigen::Vector3d binormal = halfBinormal(before, rest, angle[i - 1]) + halfBinormal(after, rest, angle[i]);
      from_rest -= 2.0 * strain.dot(binormal);
    }
    energy += 0.5 * rod.bending_stiffness[i] / rod.cell_length[i] * (strain.squaredNorm() + from_rest);
    before = after;
  }
  return energy;
}

}  // namespace

PotentialEnergy operator-(const PotentialEnergy& a, const PotentialEnergy& b)
{
  return {a.bending - b.bending, a.twist - b.twist, a.guide - b.guide, a.gravity - b.gravity};
}

PotentialEnergy operator*(double factor, const PotentialEnergy& energy)
{
  return {factor * energy.bending, factor * energy.twist, factor * energy.guide, factor * energy.gravity};
}

void addElasticEnergy(const Discretisation& rod, const TwistBoundary& hold, const State& state,
                      const std::vector<double>& twist_angle, PotentialEnergy& energy)
{
  if (rod.nodes() < 3)
    return;
  const int first = firstTwistedEdge(rod, hold);
  energy.twist += twistEnergy(rod, hold, first, twist_angle);
  energy.bending += bendingEnergy(rod, hold, first, state, twist_angle);
}

}  // namespace endovascular_sim::rod
