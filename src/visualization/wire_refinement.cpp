#include "visualization/wire_refinement.h"

#include <algorithm>
#include <cmath>

namespace endovascular_sim::visualization
{
namespace
{

constexpr int kMostParts = 8;         ///< of a segment
constexpr double kCoinciding = 1e-9;  ///< length of a segment that is not refined [m]

/** Unit vector along the sum of two vectors; zero for opposite ones. */
Eigen::Vector3d bisector(const Eigen::Vector3d& a, const Eigen::Vector3d& b)
{
  const Eigen::Vector3d sum = a + b;
  return sum.norm() > 1e-6 ? sum.normalized() : Eigen::Vector3d::Zero();
}

/** Tangent at a node: bisector of the adjacent segments. At an end it is that of the circle through the segment whose
 * other tangent is given by its neighbour. */
Eigen::Vector3d tangentAt(const std::vector<Eigen::Vector3d>& nodes, std::size_t i)
{
  const std::size_t last = nodes.size() - 1;
  const auto segment = [&nodes](std::size_t k) -> Eigen::Vector3d { return (nodes[k + 1] - nodes[k]).normalized(); };
  if (i > 0 && i < last)
    return bisector(segment(i - 1), segment(i));
  const Eigen::Vector3d chord = segment(i == 0 ? 0 : last - 1);
  if (last < 2)
    return chord;
  const Eigen::Vector3d inner = tangentAt(nodes, i == 0 ? 1 : last - 1);
  return 2.0 * chord.dot(inner) * chord - inner;
}

double interpolate(const std::vector<double>& values, std::size_t i, double share)
{
  return values[i] + share * (values[i + 1] - values[i]);
}

/** Point of a cubic Hermite curve (share in [0, 1]). */
Eigen::Vector3d hermite(const Eigen::Vector3d& a, const Eigen::Vector3d& b, const Eigen::Vector3d& tangent_a,
                        const Eigen::Vector3d& tangent_b, double share)
{
  const double length = (b - a).norm();
  const double s2 = share * share;
  const double s3 = s2 * share;
  return (2.0 * s3 - 3.0 * s2 + 1.0) * a + (3.0 * s2 - 2.0 * s3) * b +
         length * ((s3 - 2.0 * s2 + share) * tangent_a + (s3 - s2) * tangent_b);
}

}  // namespace

void refineWire(const WireState& state, double largest_turn, WireState& refined)
{
  refined.nodes.clear();
  refined.radii.clear();
  refined.forces.clear();
  refined.insertions = state.insertions;
  const bool has_forces = state.forces.size() == state.nodes.size();
  for (std::size_t i = 0; i < state.nodes.size(); ++i)
  {
    refined.nodes.push_back(state.nodes[i]);
    refined.radii.push_back(state.radii[i]);
    if (has_forces)
      refined.forces.push_back(state.forces[i]);
    if (i + 1 == state.nodes.size() || (state.nodes[i + 1] - state.nodes[i]).norm() < kCoinciding)
      continue;
    const Eigen::Vector3d begin = tangentAt(state.nodes, i);
    const Eigen::Vector3d end = tangentAt(state.nodes, i + 1);
    const double turn = std::acos(std::clamp(begin.dot(end), -1.0, 1.0));
    const int parts = std::clamp(static_cast<int>(std::ceil(turn / largest_turn)), 1, kMostParts);
    for (int part = 1; part < parts; ++part)
    {
      const double share = static_cast<double>(part) / parts;
      refined.nodes.push_back(hermite(state.nodes[i], state.nodes[i + 1], begin, end, share));
      refined.radii.push_back(interpolate(state.radii, i, share));
      if (has_forces)
        refined.forces.push_back(interpolate(state.forces, i, share));
    }
  }
}

}  // namespace endovascular_sim::visualization
