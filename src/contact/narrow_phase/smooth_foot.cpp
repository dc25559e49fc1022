#include "contact/narrow_phase/smooth_foot.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include <Eigen/Geometry>

#include "geometry/closest_point_on_triangle.h"

namespace endovascular_sim::contact
{
namespace
{

constexpr double kConverged = 1e-9;      // m: length of the last step
constexpr int kMostSteps = 80;           // of a walk
constexpr int kFreeSteps = 12;           // after which steps are shortened, against cycles
constexpr double kLeastStiffness = 0.1;  // 1 − height·curvature of the Newton matrix: 0 at the centre of curvature
constexpr double kOnBorder = 1e-12;      // barycentric coordinate below which a point lies on an edge
constexpr double kOnFeature = 1e-9;      // m: closer offsets have no direction
constexpr double kSameNormal = 1e-3;     // between offset and normal of a foot inside a patch
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

/** Coordinates of a vector in a plane along two vectors that span the plane. */
Eigen::Vector2d coordinatesAlong(const Eigen::Vector3d& e1, const Eigen::Vector3d& e2, const Eigen::Vector3d& vector)
{
  const double a = e1.dot(e1);
  const double b = e1.dot(e2);
  const double d = e2.dot(e2);
  const double x = e1.dot(vector);
  const double y = e2.dot(vector);
  return Eigen::Vector2d(d * x - b * y, a * y - b * x) / (a * d - b * b);
}

/** Barycentric coordinates of a point on a triangle. */
Eigen::Vector3d weightsOf(const Wall& wall, int triangle, const Eigen::Vector3d& point)
{
  const Eigen::Vector3i& c = wall.triangles[triangle];
  const Eigen::Vector3d& origin = wall.vertices[c[0]];
  const Eigen::Vector2d other =
      coordinatesAlong(wall.vertices[c[1]] - origin, wall.vertices[c[2]] - origin, point - origin);
  const Eigen::Vector3d weights = Eigen::Vector3d(1.0 - other.sum(), other[0], other[1]).cwiseMax(0.0);
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
  int on_edge = -1;    ///< edge that the foot lies on
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

  /** Change of the barycentric coordinates by a step in the tangent plane. */
  Eigen::Vector3d change(const Eigen::Vector3d& step) const
  {
    const Eigen::Vector2d other = coordinatesAlong(at.tangents.col(0), at.tangents.col(1), step);
    return {-other.sum(), other[0], other[1]};
  }

  /** One step inside the patch, onto its border or over it. @return whether the walk has converged */
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
    if (corner >= 0)
      cross(edgeOpposite(wall, triangle, corner));
    else
      evaluate();
    return false;
  }

  /** Continues on the other side of an edge where the next step leads on, otherwise along the edge. */
  void cross(int border)
  {
    const WallEdge& edge = wall.edges[border];
    const int other = otherTriangle(edge, triangle);
    Walker there(smooth, point);
    there.triangle = other;
    for (int vertex : edge.vertices)
      there.weights[cornerOf(wall, other, vertex)] = weights[cornerOf(wall, triangle, vertex)];
    if (there.leadsInside())
    {
      triangle = other;
      weights = there.weights;
      at = there.at;
      return;
    }
    on_edge = border;
    evaluate();
  }

  /** Evaluates a point of the border. @return whether the next step leads into the triangle */
  bool leadsInside()
  {
    evaluate();
    const Eigen::Vector3d step = stepFrom(at);
    if (step.squaredNorm() < kConverged * kConverged)
      return false;
    const Eigen::Vector3d direction = change(step);
    for (int k = 0; k < 3; ++k)
      if (weights[k] <= kOnBorder && direction[k] <= 0.0)
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

  /** One step on an edge: into one of its triangles, or along it. @return whether the walk has converged */
  bool stepOnEdge(double factor)
  {
    const WallEdge& edge = wall.edges[on_edge];
    const double parameter = weights[cornerOf(wall, triangle, edge.vertices[1])];
    for (int other : edge.triangles)
    {
      Walker there(smooth, point);
      there.triangle = other;
      there.weights = weightsOnEdge(other, edge, parameter);
      if (!there.leadsInside())
        continue;
      triangle = other;
      weights = there.weights;
      at = there.at;
      on_edge = -1;
      return false;
    }
    // Newton's method along the curve that the edge's points form.
    const Eigen::Vector3d offset = point - at.position;
    const Eigen::Vector3d along = tangentOf(edge);
    const double stiffness = std::max(kLeastStiffness * along.squaredNorm(),
                                      along.squaredNorm() - offset.dot(at.normal) * along.dot(at.curvature * along));
    const double motion = factor * offset.dot(along) / stiffness;
    const double moved = std::clamp(parameter + motion, 0.0, 1.0);
    const bool at_end = moved <= 0.0 || moved >= 1.0;
    if (!at_end && std::abs(motion) * along.norm() < kConverged)
      return true;
    weights = weightsOnEdge(triangle, edge, moved);
    evaluate();
    if (at_end)
    {
      on_vertex = edge.vertices[moved <= 0.0 ? 0 : 1];
      on_edge = -1;
    }
    return false;
  }

  /** Derivative of the position along an edge of the present triangle by the weight of its second vertex. */
  Eigen::Vector3d tangentOf(const WallEdge& edge) const
  {
    const auto derivative = [this](int vertex)
    {
      const int corner = cornerOf(wall, triangle, vertex);
      return corner == 0 ? Eigen::Vector3d(Eigen::Vector3d::Zero()) : Eigen::Vector3d(at.tangents.col(corner - 1));
    };
    return derivative(edge.vertices[1]) - derivative(edge.vertices[0]);
  }

  /** The edge of lower index of a triangle's two edges at one of its vertices. */
  int firstEdgeAt(int candidate, int vertex) const
  {
    const int corner = cornerOf(wall, candidate, vertex);
    const std::array<int, 3>& edges = wall.triangle_edges[candidate];
    return std::min(edges[corner], edges[(corner + 2) % 3]);
  }

  /** Leaves a vertex by the triangle or the edge with the longest step. @return whether there is none */
  bool stepAtVertex()
  {
    double longest = kConverged;
    Walker best(smooth, point);
    for (int e : wall.vertex_edges[on_vertex])
    {
      const WallEdge& edge = wall.edges[e];
      for (int candidate : edge.triangles)
      {
        if (e != firstEdgeAt(candidate, on_vertex))
          continue;  // two edges at the vertex belong to the triangle
        Walker there(smooth, point);
        there.triangle = candidate;
        there.weights[cornerOf(wall, candidate, on_vertex)] = 1.0;
        if (!there.leadsInside())
          continue;
        const double length = there.stepFrom(there.at).norm();
        if (length <= longest)
          continue;
        longest = length;
        best.take(there);
      }
    }
    for (int e : wall.vertex_edges[on_vertex])
    {
      const WallEdge& edge = wall.edges[e];
      const Eigen::Vector3d chord = wall.vertices[edge.otherEnd(on_vertex)] - wall.vertices[on_vertex];
      Walker there(smooth, point);
      there.triangle = edge.triangles[0];
      there.weights[cornerOf(wall, there.triangle, on_vertex)] = 1.0;
      there.evaluate();
      const Eigen::Vector3d along = there.tangentOf(edge);
      const double sign = edge.vertices[0] == on_vertex ? 1.0 : -1.0;
      const double down = sign * (point - there.at.position).dot(along.normalized());
      if (down <= longest)
        continue;
      longest = down;
      // Away from the vertex, which would end the walk again.
      const double share = std::min(0.5, down / chord.norm());
      best.triangle = there.triangle;
      best.weights = there.weightsOnEdge(there.triangle, edge, sign > 0.0 ? share : 1.0 - share);
      best.on_edge = e;
    }
    if (best.triangle < 0)
      return true;
    take(best);
    evaluate();
    return false;
  }

  /** Takes the place of another walk to the same point. */
  void take(const Walker& other)
  {
    triangle = other.triangle;
    weights = other.weights;
    at = other.at;
    on_edge = other.on_edge;
    on_vertex = other.on_vertex;
  }

  /** Walks to a foot. A walk that would end farther from the point than it began stays at its begin. */
  void run()
  {
    evaluate();
    const Walker begin(*this);
    bool done = false;
    for (int step = 0; step < kMostSteps && !done; ++step)
    {
      const double factor = step < kFreeSteps ? 1.0 : 0.5;
      done = on_vertex >= 0 ? stepAtVertex() : on_edge >= 0 ? stepOnEdge(factor) : stepInPatch(factor);
    }
    if ((point - at.position).squaredNorm() > (point - begin.at.position).squaredNorm())
      take(begin);
  }

  /** Direction that separates the lumen from the tissue at the present point. */
  Eigen::Vector3d inward() const
  {
    if (on_vertex >= 0)
      return wall.vertex_normals[on_vertex];
    if (on_edge < 0)
      return at.normal;
    const WallEdge& edge = wall.edges[on_edge];
    Walker beside(smooth, point);
    beside.triangle = otherTriangle(edge, triangle);
    beside.weights = weightsOnEdge(beside.triangle, edge, weights[cornerOf(wall, triangle, edge.vertices[1])]);
    beside.evaluate();
    return (at.normal + beside.at.normal).normalized();
  }

  SmoothFoot result() const
  {
    SmoothFoot foot;
    foot.triangle = triangle;
    foot.weights = weights;
    foot.position = at.position;
    const bool is_sharp = on_edge >= 0 ? smooth.isSharp(on_edge) : on_vertex >= 0 && smooth.isCrease(on_vertex);
    if (!is_sharp)
      foot.curvature = at.curvature;
    foot.id = on_edge >= 0     ? featureId(on_edge, FeatureKind::kEdge)
              : on_vertex >= 0 ? featureId(on_vertex, FeatureKind::kVertex)
                               : featureId(triangle, FeatureKind::kFace);
    const Eigen::Vector3d offset = point - at.position;
    const double distance = offset.norm();
    const Eigen::Vector3d towards_lumen = inward();
    const double sign = offset.dot(towards_lumen) < 0.0 ? -1.0 : 1.0;
    foot.normal = distance > kOnFeature ? Eigen::Vector3d((sign / distance) * offset) : towards_lumen;
    // Close to the surface the offset has no exact direction.
    if (on_edge < 0 && on_vertex < 0 && (foot.normal - at.normal).norm() < kSameNormal)
      foot.normal = at.normal;
    foot.height = sign * distance;
    return foot;
  }
};

SmoothFoot SmoothFootSearch::walk(const Eigen::Vector3d& point, int triangle) const
{
  Walker walker(smooth_, point);
  walker.triangle = triangle;
  const Eigen::Vector3i& c = wall_.triangles[triangle];
  const geometry::TrianglePoint closest =
      geometry::closestPointOnTriangle(point, wall_.vertices[c[0]], wall_.vertices[c[1]], wall_.vertices[c[2]]);
  walker.weights = weightsOf(wall_, triangle, closest.point);
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
