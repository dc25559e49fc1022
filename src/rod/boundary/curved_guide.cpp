#include "rod/boundary/curved_guide.h"

#include <algorithm>
#include <cmath>

#include <Eigen/Geometry>

namespace endovascular_sim::rod
{
namespace
{

using Eigen::Vector2d;
using Eigen::Vector3d;

// Gauss's rule with three points, exact up to degree five: the acting share is linear, the weight of a bow cubic.
constexpr std::array<double, 3> kPoint = {0.11270166537925831, 0.5, 0.8872983346207417};
constexpr std::array<double, 3> kWeight = {5.0 / 18.0, 8.0 / 18.0, 5.0 / 18.0};

/** Means of curvature over an edge, weighted for its bows. */
struct WeightedMean
{
  double even = 0.0;  // weight 6t(1 − t)
  double odd = 0.0;   // weight 5t(1 − t)(1 − 2t)
};

/** Adds the means of a function of arc length between two arc lengths. */
template <typename Function>
void addMean(double edge_begin, double length, double begin, double end, Function function, WeightedMean& mean)
{
  if (begin >= end)
    return;
  for (std::size_t q = 0; q < kPoint.size(); ++q)
  {
    const double at = begin + kPoint[q] * (end - begin);
    const double t = (at - edge_begin) / length;
    const double value = kWeight[q] * (end - begin) / length * t * (1.0 - t) * function(at);
    mean.even += 6.0 * value;
    mean.odd += 5.0 * (1.0 - 2.0 * t) * value;
  }
}

/** Rest curvature at a node [1/m], and its derivative by the mouth's arc length [1/m²]; ends do not bend. */
std::pair<Vector2d, Vector2d> nodalCurvature(const Discretisation& rod, const Mouth& mouth, int node)
{
  if (node < 1 || node + 1 >= rod.nodes())
    return {Vector2d::Zero(), Vector2d::Zero()};
  const double inverse = 1.0 / rod.cell_length[node];
  return {inverse * restAngle(rod.curved_parts, rod.position, node, mouth),
          -inverse * restAngleSlope(rod.curved_parts, rod.position, node, mouth)};
}

/** Bending stiffness of an edge times its length [N·m³]. */
double weightOf(const Discretisation& rod, int edge)
{
  return 0.5 * (rod.bending_stiffness[edge] + rod.bending_stiffness[edge + 1]) * rod.rest_length[edge];
}

/** True where rest curvature may differ from its mean over the nodes of an edge. */
bool isUneven(const Discretisation& rod, const Mouth& mouth, int edge)
{
  const double begin = rod.position[std::max(0, edge - 1)];
  const double end = rod.position[std::min(rod.nodes() - 1, edge + 2)];
  if (end <= mouth.begin())
    return false;
  return std::any_of(rod.curved_parts.begin(), rod.curved_parts.end(),
                     [&](const CurvedPart& part)
                     {
                       const bool uniform = part.begin <= begin && part.end >= end && mouth.end() <= begin;
                       return part.begin < end && part.end > begin && !uniform;
                     });
}

}  // namespace

RestBow restBowAt(const Discretisation& rod, const Mouth& mouth, int edge)
{
  RestBow bow;
  const double length = rod.rest_length[edge];
  const double edge_begin = rod.position[edge];
  const double edge_end = rod.position[edge + 1];
  Vector2d even = Vector2d::Zero();
  Vector2d odd = Vector2d::Zero();
  Vector2d even_slope = Vector2d::Zero();
  Vector2d odd_slope = Vector2d::Zero();
  for (const CurvedPart& part : rod.curved_parts)
  {
    const double begin = std::max(edge_begin, part.begin);
    const double end = std::min(edge_end, part.end);
    WeightedMean mean, slope;
    addMean(
        edge_begin, length, std::max(begin, mouth.begin()), std::min(end, mouth.end()),
        [&mouth](double at) { return mouth.share(at); }, mean);
    addMean(
        edge_begin, length, std::max(begin, mouth.end()), end, [](double) { return 1.0; }, mean);
    addMean(
        edge_begin, length, std::max(begin, mouth.begin()), std::min(end, mouth.end()),
        [&mouth](double) { return -0.5 / mouth.half_width; }, slope);
    even += mean.even * part.curvature;
    odd += mean.odd * part.curvature;
    even_slope += slope.even * part.curvature;
    odd_slope += slope.odd * part.curvature;
  }
  const auto [before, before_slope] = nodalCurvature(rod, mouth, edge);
  const auto [after, after_slope] = nodalCurvature(rod, mouth, edge + 1);
  const double square = length * length;
  bow.even = -0.125 * square * (even - 0.5 * (before + after));
  bow.even_slope = -0.125 * square * (even_slope - 0.5 * (before_slope + after_slope));
  bow.odd = -square * odd;
  bow.odd_slope = -square * odd_slope;
  return bow;
}

double CurvedGuide::forceAtMouth(const Discretisation& rod, const TwistBoundary& hold, const State& state) const
{
  Walk walk{rod, hold, state, {hold.tangent, hold.director}};
  CurvedGuideTerm term;
  double force = 0.0;
  for (int j = state.first_node; j + 1 < rod.nodes() && guide_.holds(state.position[j]); ++j)
    if (follow(walk, j))
    {
      evaluateUneven(walk, j, term);
      force -= term.by_mouth;
    }
  return force;
}

/** Bow by the positions of four nodes: the mean of the curvatures at both ends of the edge, which are linear in the
 *  positions. */
EdgeBow CurvedGuide::bowOf(const Walk& walk, int edge, CurvedGuideTerm& term)
{
  const Discretisation& rod = walk.rod;
  term.spread = {0.0, 0.0, 0.0, 0.0};
  EdgeBow bow;
  for (int k = 0; k < 2; ++k)
  {
    const int i = edge + k;
    if (i <= walk.state.first_node || i + 1 >= rod.nodes())
      continue;
    const double factor = -0.0625 * rod.rest_length[edge] * rod.rest_length[edge] / rod.cell_length[i];
    const double before = factor / rod.rest_length[i - 1];
    const double after = factor / rod.rest_length[i];
    term.spread[k] += before;
    term.spread[k + 1] -= before + after;
    term.spread[k + 2] += after;
  }
  for (int k = 0; k < 4; ++k)
    if (term.spread[k] != 0.0)
      bow.even += term.spread[k] * walk.state.position[edge - 1 + k];
  return bow;
}

/** Moves the frame to an edge, from the first one on that carries a RestBow or lies beyond the hold.
 *  @return true where the edge may have a RestBow */
bool CurvedGuide::follow(Walk& walk, int edge)
{
  const Discretisation& rod = walk.rod;
  const bool beyond = 0.5 * (rod.position[edge] + rod.position[edge + 1]) >= walk.hold.position;
  const bool uneven = isUneven(rod, walk.hold.mouth(), edge);
  walk.curved = walk.curved || uneven || beyond;
  if (walk.curved)
    walk.frame.moveTo((walk.state.position[edge + 1] - walk.state.position[edge]).normalized());
  return uneven;
}

void CurvedGuide::evaluate(Walk& walk, int edge, CurvedGuideTerm& term) const
{
  if (follow(walk, edge))
  {
    evaluateUneven(walk, edge, term);
    return;
  }
  const std::vector<Vector3d>& x = walk.state.position;
  guide_.evaluate(x[edge], x[edge + 1], bowOf(walk, edge, term), weightOf(walk.rod, edge), term.edge);
  term.by_mouth = 0.0;
}

/** Computes the term of an edge with a RestBow, whose frame is that of the walk. */
void CurvedGuide::evaluateUneven(const Walk& walk, int edge, CurvedGuideTerm& term) const
{
  const State& state = walk.state;
  const Vector3d& first = state.position[edge];
  const Vector3d& second = state.position[edge + 1];
  EdgeBow bow = bowOf(walk, edge, term);
  const RestBow rest = restBowAt(walk.rod, walk.hold.mouth(), edge);
  const auto [m1, m2] = walk.frame.materialAxes(state.twist_angle[edge]);
  const Vector3d even = rest.even.x() * m1 + rest.even.y() * m2;
  const Vector3d odd = rest.odd.x() * m1 + rest.odd.y() * m2;
  bow.even += even;
  bow.odd += odd;
  guide_.evaluate(first, second, bow, weightOf(walk.rod, edge), term.edge);
  term.by_mouth = term.edge.by_bow.even.dot(rest.even_slope.x() * m1 + rest.even_slope.y() * m2) +
                  term.edge.by_bow.odd.dot(rest.odd_slope.x() * m1 + rest.odd_slope.y() * m2);
  const Vector3d couple = even.cross(term.edge.by_bow.even) + odd.cross(term.edge.by_bow.odd);
  const Vector3d tilt = couple.cross(walk.frame.tangent) / (second - first).norm();
  term.edge.gradient[0] -= tilt;
  term.edge.gradient[1] += tilt;
}

}  // namespace endovascular_sim::rod
