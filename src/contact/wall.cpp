#include "contact/wall.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <unordered_map>

#include <Eigen/Geometry>

namespace endovascular_sim::contact
{
namespace
{

constexpr double kFlat = 1e-3;       // rad: below it an edge counts as flat
constexpr int kCurvatureRounds = 2;  // of neighbours over which curvature is averaged

double clampedAcos(double cosine)
{
  return std::acos(std::max(-1.0, std::min(1.0, cosine)));
}

int oppositeCorner(const Eigen::Vector3i& triangle, const WallEdge& edge)
{
  for (int corner = 0; corner < 3; ++corner)
    if (triangle[corner] != edge.vertices[0] && triangle[corner] != edge.vertices[1])
      return triangle[corner];
  return triangle[0];
}

}  // namespace

Wall::Wall(const vessel::TriangleMesh& mesh) : vertices(mesh.vertices), triangles(mesh.triangles)
{
  normals.resize(triangles.size());
  plane_offsets.resize(triangles.size());
  triangle_edges.resize(triangles.size());
  vertex_normals.assign(vertices.size(), Eigen::Vector3d::Zero());
  vertex_edges.resize(vertices.size());
  vertex_reflex.assign(vertices.size(), 0);
  std::unordered_map<std::uint64_t, int> edge_of_pair;
  edge_of_pair.reserve(triangles.size() * 2);
  for (std::size_t t = 0; t < triangles.size(); ++t)
  {
    const Eigen::Vector3i& corners = triangles[t];
    const Eigen::Vector3d& origin = vertices[corners[0]];
    normals[t] = -(vertices[corners[1]] - origin).cross(vertices[corners[2]] - origin).normalized();
    plane_offsets[t] = normals[t].dot(origin);
    for (int k = 0; k < 3; ++k)
    {
      const int a = corners[k];
      const int b = corners[(k + 1) % 3];
      const int c = corners[(k + 2) % 3];
      const double angle =
          clampedAcos((vertices[b] - vertices[a]).normalized().dot((vertices[c] - vertices[a]).normalized()));
      vertex_normals[a] += angle * normals[t];
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
  }
  for (Eigen::Vector3d& normal : vertex_normals)
    normal.normalize();
  for (std::size_t e = 0; e < edges.size(); ++e)
  {
    finishEdge(edges[e]);
    for (int vertex : edges[e].vertices)
    {
      vertex_edges[vertex].push_back(static_cast<int>(e));
      if (edges[e].reflex_angle > kFlat)
        vertex_reflex[vertex] = 1;
    }
  }
  findCurvature();
}

/** Cohen-Steiner & Morvan 2003: an edge of length l whose triangles meet at an angle β bends the wall by β l across
 *  itself. Every vertex gets half of its edges' and a third of its triangles' areas, spread over its neighbours, so
 * that one facet's shape counts little. */
void Wall::findCurvature()
{
  std::vector<Eigen::Matrix3d> bend(vertices.size(), Eigen::Matrix3d::Zero());
  std::vector<double> area(vertices.size(), 0.0);
  for (const WallEdge& edge : edges)
  {
    const Eigen::Vector3d along = vertices[edge.vertices[1]] - vertices[edge.vertices[0]];
    const Eigen::Vector3d across = along.normalized().cross(edge.normal);
    for (int vertex : edge.vertices)
      bend[vertex] -= 0.5 * edge.reflex_angle * along.norm() * across * across.transpose();
  }
  for (const Eigen::Vector3i& t : triangles)
    for (int corner = 0; corner < 3; ++corner)
      area[t[corner]] += (vertices[t[1]] - vertices[t[0]]).cross(vertices[t[2]] - vertices[t[0]]).norm() / 6.0;
  for (int round = 0; round < kCurvatureRounds; ++round)
  {
    std::vector<Eigen::Matrix3d> wide_bend = bend;
    std::vector<double> wide_area = area;
    for (const WallEdge& edge : edges)
      for (int side = 0; side < 2; ++side)
      {
        wide_bend[edge.vertices[side]] += bend[edge.vertices[1 - side]];
        wide_area[edge.vertices[side]] += area[edge.vertices[1 - side]];
      }
    bend.swap(wide_bend);
    area.swap(wide_area);
  }
  curvature.reserve(triangles.size());
  for (const Eigen::Vector3i& t : triangles)
    curvature.push_back((bend[t[0]] + bend[t[1]] + bend[t[2]]) / (area[t[0]] + area[t[1]] + area[t[2]]));
}

void Wall::finishEdge(WallEdge& edge)
{
  if (edge.triangles[1] < 0)
    edge.triangles[1] = edge.triangles[0];
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
