#include "contact/narrow_phase/smooth_foot.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <Eigen/Geometry>
#include <Eigen/LU>

namespace endovascular_sim::contact
{
namespace
{

constexpr double kConverged = 1e-10;     // m: length of the last step
constexpr int kMostSteps = 80;           // of a walk
constexpr int kFreeSteps = 12;           // after which steps are shortened, against cycles
constexpr double kLeastStiffness = 0.1;  // 1 − height·curvature of the Newton matrix: 0 at the centre of curvature
constexpr double kOnBorder = 1e-12;      // barycentric coordinate below which a point lies on an edge
constexpr double kOnFeature = 1e-12;     // m: closer offsets have no direction
constexpr double kLeastClearance = 0.05e-3;  // m

/** Edge of a triangle opposite to a corner. */
int edgeOpposite(const Wall& wall, int triangle, int corner)
{
  return wall.triangle_edges[triangle][(corner + 1) % 3];
}

int otherTriangle(const WallEdge& edge, int triangle)
{
  return edge.triangles[0] == triangle ? edge.triangles[1] : edge.triangles[0];
}

int cornerOf(const Wall& wall, int triangle, int vertex)
{
  const Eigen::Vector3i& c = wall.triangles[triangle];
  return c[0] == vertex ? 0 : c[1] == vertex ? 1 : 2;
}

Eigen::Vector3d weightsIn(const Wall& wall, int triangle, const Eigen::Vector3d& point)
{
  const Eigen::Vector3i& c = wall.triangles[triangle];
  const Eigen::Vector3d e1 = wall.vertices[c[1]] - wall.vertices[c[0]];
  const Eigen::Vector3d e2 = wall.vertices[c[2]] - wall.vertices[c[0]];
  const Eigen::Vector3d from = point - wall.vertices[c[0]];
  const double a = e1.dot(e1);
  const double b = e1.dot(e2);
  const double d = e2.dot(e2);
  const double determinant = a * d - b * b;
  Eigen::Vector3d weights;
  weights[1] = (d * e1.dot(from) - b * e2.dot(from)) / determinant;
  weights[2] = (a * e2.dot(from) - b * e1.dot(from)) / determinant;
  weights[0] = 1.0 - weights[1] - weights[2];
  weights = weights.cwiseMax(0.0);
  return weights / weights.sum();
}

}  // namespace

/** State of a walk. */
struct SmoothFootSearch::Walker
{
  Walker(const SmoothWall& smooth_wall, const Eigen::Vector3d& target)
    : smooth(smooth_wall), wall(smooth_wall.wall()), point(target)
  {
  }

  const SmoothWall& smooth;
  const Wall& wall;
  const Eigen::Vector3d point;
  int triangle = -1;
  Eigen::Vector3d weights = Eigen::Vector3d::Zero();
  SmoothWall::Point at;
  int on_edge = -1;    ///< sharp edge that the foot lies on
  int on_vertex = -1;  ///< vertex that the foot lies on

  void evaluate() { at = smooth.at(triangle, weights); }

  /** Tangential motion from a point of the surface towards the foot: Newton's method on its curvature. */
  Eigen::Vector3d stepFrom(const SmoothWall::Point& from) const
  {
    const Eigen::Vector3d offset = point - from.position;
    const double height = offset.dot(from.normal);
    const Eigen::Vector3d tangential = offset - height * from.normal;
    const Eigen::Vector3d t1 = from.normal.unitOrthogonal();
    const Eigen::Vector3d t2 = from.normal.cross(t1);
    // (1 − height K) step = tangential, with the eigenvalues of the matrix bounded from below.
    const double k11 = t1.dot(from.curvature * t1);
    const double k12 = t1.dot(from.curvature * t2);
    const double k22 = t2.dot(from.curvature * t2);
    const double mean = 1.0 - 0.5 * height * (k11 + k22);
    const double half = 0.5 * std::abs(height) * std::hypot(k11 - k22, 2.0 * k12);
    const double add = std::max(0.0, kLeastStiffness - (mean - half));
    const double a = 1.0 - height * k11 + add;
    const double b = -height * k12;
    const double d = 1.0 - height * k22 + add;
    const double x = t1.dot(tangential);
    const double y = t2.dot(tangential);
    const double determinant = a * d - b * b;
    return ((d * x - b * y) / determinant) * t1 + ((a * y - b * x) / determinant) * t2;
  }

  void moveTo(int other, int edge)
  {
    const Eigen::Vector3d before = weights;
    const int from = triangle;
    triangle = other;
    weights.setZero();
    for (int vertex : wall.edges[edge].vertices)
      weights[cornerOf(wall, triangle, vertex)] = before[cornerOf(wall, from, vertex)];
    weights /= weights.sum();
  }

  /** Change of the barycentric coordinates of the full step in the present patch. */
  Eigen::Vector3d change(const Eigen::Vector3d& step) const
  {
    return smooth.weightsChange(triangle, weights, at, step);
  }

  int cornerWithLeast(const Eigen::Vector3d& values) const
  {
    int corner = 0;
    values.minCoeff(&corner);
    return corner;
  }

  /** One step inside the patch, over a smooth edge or onto a sharp one. @return whether the walk has converged */
  bool stepInPatch(double factor)
  {
    const Eigen::Vector3d step = factor * stepFrom(at);
    if (step.squaredNorm() < kConverged * kConverged)
      return true;
    const Eigen::Vector3d direction = change(step);
    double share = 1.0;
    int corner = -1;
    for (int k = 0; k < 3; ++k)
      if (weights[k] + direction[k] < 0.0 && (corner < 0 || weights[k] < share * -direction[k]))
      {
        share = std::max(0.0, weights[k] / -direction[k]);
        corner = k;
      }
    weights += share * direction;
    weights = weights.cwiseMax(0.0);
    if (corner >= 0)
      weights[corner] = 0.0;
    weights /= weights.sum();
    if (corner < 0)
    {
      evaluate();
      return false;
    }
    const int edge = edgeOpposite(wall, triangle, corner);
    const int other = otherTriangle(wall.edges[edge], triangle);
    if (!smooth.isSharp(edge))
    {
      moveTo(other, edge);
      evaluate();
      return false;
    }
    on_edge = edge;
    evaluate();
    return false;
  }

  /** Whether a step from the present point of the border leads into a triangle that contains it. */
  bool leadsInto(int candidate, const Eigen::Vector3d& weights_there, double& length) const
  {
    Walker there(smooth, point);
    there.triangle = candidate;
    there.weights = weights_there;
    there.evaluate();
    const Eigen::Vector3d step = there.stepFrom(there.at);
    length = step.norm();
    if (length < kConverged)
      return false;
    const Eigen::Vector3d direction = there.change(step);
    for (int k = 0; k < 3; ++k)
      if (weights_there[k] <= kOnBorder && direction[k] <= 0.0)
        return false;
    return true;
  }

  Eigen::Vector3d weightsOnEdge(int candidate, const WallEdge& edge, double parameter) const
  {
    Eigen::Vector3d there = Eigen::Vector3d::Zero();
    there[cornerOf(wall, candidate, edge.vertices[0])] = 1.0 - parameter;
    there[cornerOf(wall, candidate, edge.vertices[1])] = parameter;
    return there;
  }

  /** One step on a sharp edge: into one of its triangles, or along it. @return whether the walk has converged */
  bool stepOnEdge(double factor)
  {
    const WallEdge& edge = wall.edges[on_edge];
    const double parameter = weights[cornerOf(wall, triangle, edge.vertices[1])];
    for (int other : edge.triangles)
    {
      const Eigen::Vector3d there = weightsOnEdge(other, edge, parameter);
      double length = 0.0;
      if (!leadsInto(other, there, length))
        continue;
      triangle = other;
      weights = there;
      on_edge = -1;
      evaluate();
      return false;
    }
    const Eigen::Vector3d along = wall.vertices[edge.vertices[1]] - wall.vertices[edge.vertices[0]];
    const double motion = factor * (point - at.position).dot(along) / along.squaredNorm();
    const double moved = std::clamp(parameter + motion, 0.0, 1.0);
    const bool at_end = moved <= 0.0 || moved >= 1.0;
    weights = weightsOnEdge(triangle, edge, moved);
    evaluate();
    if (at_end)
    {
      on_vertex = edge.vertices[moved <= 0.0 ? 0 : 1];
      on_edge = -1;
      return false;
    }
    return std::abs(motion) * along.norm() < kConverged;
  }

  /** Leaves a vertex by the triangle or the sharp edge with the longest step. @return whether there is none */
  bool stepAtVertex()
  {
    double longest = kConverged;
    int into = -1;
    int onto = -1;
    const auto weights_at = [this](int candidate)
    { return Eigen::Vector3d(Eigen::Vector3d::Unit(cornerOf(wall, candidate, on_vertex))); };
    for (int e : wall.vertex_edges[on_vertex])
    {
      const WallEdge& edge = wall.edges[e];
      for (int candidate : edge.triangles)
      {
        double length = 0.0;
        if (leadsInto(candidate, weights_at(candidate), length) && length > longest)
        {
          longest = length;
          into = candidate;
          onto = -1;
        }
      }
      const Eigen::Vector3d along = (wall.vertices[edge.otherEnd(on_vertex)] - wall.vertices[on_vertex]).normalized();
      const double down = (point - at.position).dot(along);
      if (smooth.isSharp(e) && down > longest)
      {
        longest = down;
        onto = e;
        into = -1;
      }
    }
    if (into < 0 && onto < 0)
      return true;
    triangle = into >= 0 ? into : wall.edges[onto].triangles[0];
    weights = weights_at(triangle);
    if (onto >= 0)
    {
      // Away from the vertex, which would end the walk again.
      const WallEdge& edge = wall.edges[onto];
      const double length = (wall.vertices[edge.vertices[1]] - wall.vertices[edge.vertices[0]]).norm();
      const double share = std::min(0.5, longest / length);
      weights = weightsOnEdge(triangle, edge, edge.vertices[0] == on_vertex ? share : 1.0 - share);
    }
    on_edge = onto;
    on_vertex = -1;
    evaluate();
    return false;
  }

  void run()
  {
    evaluate();
    for (int step = 0; step < kMostSteps; ++step)
    {
      const double factor = step < kFreeSteps ? 1.0 : 0.5;
      const bool done = on_vertex >= 0 ? stepAtVertex() : on_edge >= 0 ? stepOnEdge(factor) : stepInPatch(factor);
      if (done)
        return;
    }
  }

  SmoothFoot result() const
  {
    SmoothFoot foot;
    foot.triangle = triangle;
    foot.weights = weights;
    foot.position = at.position;
    foot.normal = at.normal;
    const Eigen::Vector3d offset = point - at.position;
    const bool at_border = on_edge >= 0 || (on_vertex >= 0 && smooth.isCrease(on_vertex));
    if (!at_border)
    {
      foot.curvature = at.curvature;
      foot.height = offset.dot(at.normal);
      foot.id = featureId(triangle, FeatureKind::kFace);
      return foot;
    }
    const Eigen::Vector3d& inward = on_edge >= 0 ? wall.edges[on_edge].normal : wall.vertex_normals[on_vertex];
    const double distance = offset.norm();
    const double sign = offset.dot(inward) < 0.0 ? -1.0 : 1.0;
    foot.normal = distance > kOnFeature ? Eigen::Vector3d((sign / distance) * offset) : inward;
    foot.height = sign * distance;
    foot.id = on_edge >= 0 ? featureId(on_edge, FeatureKind::kEdge) : featureId(on_vertex, FeatureKind::kVertex);
    return foot;
  }
};

SmoothFoot SmoothFootSearch::walk(const Eigen::Vector3d& point, int triangle, const Eigen::Vector3d& start) const
{
  Walker walker(smooth_, point);
  walker.triangle = triangle;
  walker.weights = weightsIn(wall_, triangle, start);
  walker.run();
  return walker.result();
}

SmoothFoot SmoothFootSearch::walk(const Eigen::Vector3d& point, const SmoothFoot& from) const
{
  Walker walker(smooth_, point);
  walker.triangle = from.triangle;
  walker.weights = from.weights;
  walker.run();
  return walker.result();
}

NarrowPhase::Minimum minimumOf(const SmoothFoot& foot, const Eigen::Vector3d& point)
{
  NarrowPhase::Minimum minimum;
  minimum.distance = std::abs(foot.height);
  minimum.outside = foot.height < 0.0;
  minimum.feature.triangle = foot.triangle;
  minimum.feature.normal = foot.normal;
  minimum.feature.gap = foot.height;
  minimum.feature.point = point - foot.height * foot.normal;
  minimum.feature.id = foot.id;
  return minimum;
}

double clearanceRadiusOf(const SmoothFoot& foot, const Eigen::Vector3d& wire_edge, double radius)
{
  const Eigen::Vector3d across = foot.normal.cross(wire_edge);
  const double curvature = across.dot(foot.curvature * across) / across.squaredNorm();
  return curvature > 0.0 ? std::max(kLeastClearance, 1.0 / curvature - radius)
                         : std::numeric_limits<double>::infinity();
}

}  // namespace endovascular_sim::contact
