#include "contact/wall/wall.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <unordered_map>

#include <Eigen/Geometry>

namespace endovascular_sim::contact
{
namespace
{

constexpr double kFlat = 1e-3;         // rad: below it an edge counts as flat
constexpr double kSmooth = 0.5;        // slope up to which the triangles around a vertex form one smooth sheet
constexpr double kWidestCorner = 2.4;  // rad

int oppositeCorner(const Eigen::Vector3i& triangle, const WallEdge& edge)
{
  for (int corner = 0; corner < 3; ++corner)
    if (triangle[corner] != edge.vertices[0] && triangle[corner] != edge.vertices[1])
      return triangle[corner];
  return triangle[0];
}

int cornerAt(const Eigen::Vector3i& triangle, int vertex)
{
  return triangle[0] == vertex ? 0 : triangle[1] == vertex ? 1 : 2;
}

}  // namespace

Wall::Wall(const geometry::TriangleMesh& mesh)
  : vertices(mesh.vertices),
    triangles(mesh.triangles),
    vertex_marked_(mesh.vertices.size(), 0),
    triangle_marked_(mesh.triangles.size(), 0)
{
  connect();
  normals.resize(triangles.size());
  plane_offsets.resize(triangles.size());
  angles_.resize(triangles.size());
  areas_.resize(triangles.size());
  for (std::size_t t = 0; t < triangles.size(); ++t)
    updateTriangle(static_cast<int>(t));
  edge_bends_.resize(edges.size());
  for (std::size_t e = 0; e < edges.size(); ++e)
  {
    updateEdge(edges[e]);
    updateEdgeBend(static_cast<int>(e));
  }
  vertex_normals.resize(vertices.size());
  vertex_reflex.resize(vertices.size());
  vertex_cone.resize(vertices.size());
  bends_.fill(std::vector<Bend>(vertices.size()));
  const int count = static_cast<int>(vertices.size());
  for (int v = 0; v < count; ++v)
  {
    updateVertex(v);
    bends_[0][v] = bendAt(v);
  }
  for (int round = 1; round <= kCurvatureRounds; ++round)
    for (int v = 0; v < count; ++v)
      bends_[round][v] = averagedBend(v, round);
  curvature.resize(triangles.size());
  for (std::size_t t = 0; t < triangles.size(); ++t)
    updateCurvature(static_cast<int>(t));
  edge_marked_.assign(edges.size(), 0);
}

/** Sets the adjacency. */
void Wall::connect()
{
  triangle_edges.resize(triangles.size());
  vertex_edges.resize(vertices.size());
  vertex_triangles_.resize(vertices.size());
  std::unordered_map<std::uint64_t, int> edge_of_pair;
  edge_of_pair.reserve(triangles.size() * 2);
  for (std::size_t t = 0; t < triangles.size(); ++t)
    for (int k = 0; k < 3; ++k)
    {
      const int a = triangles[t][k];
      const int b = triangles[t][(k + 1) % 3];
      vertex_triangles_[a].push_back(static_cast<int>(t));
      const std::uint64_t pair =
          static_cast<std::uint64_t>(std::min(a, b)) << 32 | static_cast<std::uint32_t>(std::max(a, b));
      const auto [entry, is_new] = edge_of_pair.emplace(pair, static_cast<int>(edges.size()));
      if (is_new)
      {
        edges.emplace_back();
        edges.back().vertices = {std::min(a, b), std::max(a, b)};
        edges.back().triangles[0] = static_cast<int>(t);
      }
      else
        edges[entry->second].triangles[1] = static_cast<int>(t);
      triangle_edges[t][k] = entry->second;
    }
  for (std::size_t e = 0; e < edges.size(); ++e)
  {
    if (edges[e].triangles[1] < 0)
      edges[e].triangles[1] = edges[e].triangles[0];
    for (int vertex : edges[e].vertices)
      vertex_edges[vertex].push_back(static_cast<int>(e));
  }
}

void Wall::updateTriangle(int triangle)
{
  const Eigen::Vector3i& corners = triangles[triangle];
  const Eigen::Vector3d& origin = vertices[corners[0]];
  const Eigen::Vector3d cross = (vertices[corners[1]] - origin).cross(vertices[corners[2]] - origin);
  normals[triangle] = -cross.normalized();
  plane_offsets[triangle] = normals[triangle].dot(origin);
  areas_[triangle] = 0.5 * cross.norm();
  std::array<Eigen::Vector3d, 3> along;  // unit, from each corner to the next
  for (int k = 0; k < 3; ++k)
    along[k] = (vertices[corners[(k + 1) % 3]] - vertices[corners[k]]).normalized();
  for (int k = 0; k < 3; ++k)
    angles_[triangle][k] = angleBetween(-along[k], along[(k + 2) % 3]);
}

void Wall::updateVertex(int vertex)
{
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (int t : vertex_triangles_[vertex])
    sum += angles_[t][cornerAt(triangles[t], vertex)] * normals[t];
  vertex_normals[vertex] = sum.normalized();
  vertex_reflex[vertex] = 0;
  for (int e : vertex_edges[vertex])
    if (edges[e].reflex_angle > kFlat)
      vertex_reflex[vertex] = 1;
  vertex_cone[vertex] = coneAt(vertex);
}

/** Bound of the normal cone of a vertex.
 *
 *  A direction d in the cone has d·e ≤ 0 for every edge e at the vertex. Let γ be the widest corner angle and s the
 *  steepest descending slope of an edge. Some edge lies within γ/2 of the direction in which d is tilted, so the tilt ψ
 *  is bounded by tan ψ ≤ s/cos(γ/2). */
double Wall::coneAt(int vertex) const
{
  const Eigen::Vector3d& normal = vertex_normals[vertex];
  double steepest = 0.0;  // descending slope
  for (int e : vertex_edges[vertex])
  {
    const Eigen::Vector3d along = vertices[edges[e].otherEnd(vertex)] - vertices[vertex];
    const double rise = along.dot(normal);
    const double run = (along - rise * normal).norm();
    if (std::abs(rise) >= kSmooth * run)
      return M_PI_2;
    steepest = std::max(steepest, -rise / run);
  }
  double widest = 0.0;  // corner angle projected along the normal [rad]
  double around = 0.0;
  for (int t : vertex_triangles_[vertex])
  {
    const Eigen::Vector3i& corners = triangles[t];
    const int k = cornerAt(corners, vertex);
    const Eigen::Vector3d to_next = vertices[corners[(k + 1) % 3]] - vertices[vertex];
    const Eigen::Vector3d to_last = vertices[corners[(k + 2) % 3]] - vertices[vertex];
    const Eigen::Vector3d a = to_next - normal.dot(to_next) * normal;
    const Eigen::Vector3d b = to_last - normal.dot(to_last) * normal;
    const double angle = std::atan2(a.cross(b).norm(), a.dot(b));
    if (normals[t].dot(normal) * normals[t].dot(normal) < 1.0 / (1.0 + kSmooth * kSmooth) ||
        normals[t].dot(normal) <= 0.0)
      return M_PI_2;
    widest = std::max(widest, angle);
    around += angle;
  }
  if (widest > kWidestCorner || std::abs(around - 2.0 * M_PI) > 1e-6)
    return M_PI_2;
  return std::atan(steepest / std::cos(0.5 * widest));
}

/** Integral of the curvature of an edge (Cohen-Steiner & Morvan 2003): β l in the direction across the edge, for an
 *  edge of length l between triangles that meet at an angle β. A vertex gets half of its edges' integrals and a third
 *  of its triangles' areas. Averaging over neighbours reduces the influence of single facets. */
void Wall::updateEdgeBend(int edge)
{
  const WallEdge& e = edges[edge];
  const Eigen::Vector3d along = vertices[e.vertices[1]] - vertices[e.vertices[0]];
  edge_bends_[edge] = {along.normalized().cross(e.normal), 0.5 * e.reflex_angle * along.norm()};
}

Wall::Bend Wall::bendAt(int vertex) const
{
  Bend sum;
  for (int e : vertex_edges[vertex])
  {
    const EdgeBend& edge = edge_bends_[e];
    sum.bend -= edge.weight * edge.across * edge.across.transpose();
  }
  for (int t : vertex_triangles_[vertex])
    sum.area += areas_[t] / 3.0;
  return sum;
}

Wall::Bend Wall::averagedBend(int vertex, int round) const
{
  const std::vector<Bend>& before = bends_[round - 1];
  Bend sum = before[vertex];
  for (int e : vertex_edges[vertex])
  {
    const Bend& other = before[edges[e].otherEnd(vertex)];
    sum.bend += other.bend;
    sum.area += other.area;
  }
  return sum;
}

void Wall::updateCurvature(int triangle)
{
  const Eigen::Vector3i& c = triangles[triangle];
  const std::vector<Bend>& bends = bends_[kCurvatureRounds];
  curvature[triangle] = (bends[c[0]].bend + bends[c[1]].bend + bends[c[2]].bend) /
                        (bends[c[0]].area + bends[c[1]].area + bends[c[2]].area);
}

/** Appends the neighbours of some marked vertices and marks them. */
void Wall::appendNeighbours(std::vector<int>& around)
{
  const std::size_t count = around.size();
  for (std::size_t k = 0; k < count; ++k)
    for (int e : vertex_edges[around[k]])
      for (int v : edges[e].vertices)
        if (!vertex_marked_[v])
        {
          vertex_marked_[v] = 1;
          around.push_back(v);
        }
}

/** Moves the vertices. Collects and marks the triangles with a moved vertex, their edges and their vertices. */
void Wall::moveAndMark(const std::vector<int>& indices, const std::vector<Eigen::Vector3d>& positions)
{
  changes_.triangles.clear();
  moved_edges_.clear();
  ring_.clear();
  for (std::size_t k = 0; k < indices.size(); ++k)
  {
    vertices[indices[k]] = positions[k];
    for (int t : vertex_triangles_[indices[k]])
      if (!triangle_marked_[t])
      {
        triangle_marked_[t] = 1;
        changes_.triangles.push_back(t);
      }
  }
  for (int t : changes_.triangles)
    for (int k = 0; k < 3; ++k)
    {
      const int e = triangle_edges[t][k];
      const int v = triangles[t][k];
      if (!edge_marked_[e])
        edge_marked_[e] = 1, moved_edges_.push_back(e);
      if (!vertex_marked_[v])
        vertex_marked_[v] = 1, ring_.push_back(v);
    }
}

/** Collects the triangles that share a vertex with a moved one, and their edges. Unmarks all triangles and edges. */
void Wall::collectNeighbours()
{
  changes_.around = changes_.triangles;
  for (int v : ring_)
    for (int t : vertex_triangles_[v])
      if (!triangle_marked_[t])
      {
        triangle_marked_[t] = 1;
        changes_.around.push_back(t);
      }
  changes_.edges = moved_edges_;
  for (int t : changes_.around)
  {
    triangle_marked_[t] = 0;
    for (int e : triangle_edges[t])
      if (!edge_marked_[e])
        edge_marked_[e] = 1, changes_.edges.push_back(e);
  }
  for (int e : changes_.edges)
    edge_marked_[e] = 0;
}

const Wall::Changes& Wall::moveVertices(const std::vector<int>& indices, const std::vector<Eigen::Vector3d>& positions)
{
  moveAndMark(indices, positions);
  for (int t : changes_.triangles)
    updateTriangle(t);
  for (int e : moved_edges_)
  {
    updateEdge(edges[e]);
    updateEdgeBend(e);
  }
  for (int v : ring_)
  {
    updateVertex(v);
    bends_[0][v] = bendAt(v);
  }
  collectNeighbours();
  for (int round = 1; round <= kCurvatureRounds; ++round)
  {
    appendNeighbours(ring_);
    for (int v : ring_)
      bends_[round][v] = averagedBend(v, round);
  }
  curved_.clear();
  for (int v : ring_)
  {
    vertex_marked_[v] = 0;
    for (int t : vertex_triangles_[v])
      if (!triangle_marked_[t])
      {
        triangle_marked_[t] = 1;
        curved_.push_back(t);
      }
  }
  for (int t : curved_)
    triangle_marked_[t] = 0;
  for (int t : curved_)
    updateCurvature(t);
  return changes_;
}

void Wall::updateEdge(WallEdge& edge)
{
  const Eigen::Vector3d& origin = vertices[edge.vertices[0]];
  const Eigen::Vector3d along = (vertices[edge.vertices[1]] - origin).normalized();
  for (int side = 0; side < 2; ++side)
  {
    const Eigen::Vector3d corner = vertices[oppositeCorner(triangles[edge.triangles[side]], edge)] - origin;
    edge.into_triangle[side] = (corner - corner.dot(along) * along).normalized();
  }
  const Eigen::Vector3d& n0 = normals[edge.triangles[0]];
  const Eigen::Vector3d& n1 = normals[edge.triangles[1]];
  const Eigen::Vector3d sum = n0 + n1;
  edge.normal = sum.squaredNorm() > 1e-20 ? Eigen::Vector3d(sum.normalized()) : n0;
  // atan2 keeps small angles exact where acos does not.
  const double angle = std::atan2(n0.cross(n1).norm(), n0.dot(n1));
  edge.reflex_angle = edge.into_triangle[1].dot(n0) > 0.0 ? -angle : angle;
}

}  // namespace endovascular_sim::contact
