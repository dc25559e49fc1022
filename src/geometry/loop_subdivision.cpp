#include "geometry/loop_subdivision.h"

#include <algorithm>
#include <cmath>

#include <Eigen/Geometry>

#include "geometry/mesh_topology.h"
#include "geometry/vertex_normals.h"

namespace endovascular_sim::geometry
{
namespace
{

/** Index of the new vertex on each edge of each triangle; vertices are numbered in the order of the sorted edges. */
std::vector<Eigen::Vector3i> edgeVertices(const TriangleMesh& mesh, const std::vector<HalfEdge>& half_edges)
{
  std::vector<Eigen::Vector3i> edge_vertex(mesh.triangles.size());
  int next = static_cast<int>(mesh.vertices.size());
  for (std::size_t begin = 0; begin < half_edges.size(); begin = endOfEdge(half_edges, begin), ++next)
    for (std::size_t k = begin; k < endOfEdge(half_edges, begin); ++k)
      edge_vertex[static_cast<std::size_t>(half_edges[k].triangle)][half_edges[k].side] = next;
  return edge_vertex;
}

std::vector<Eigen::Vector3i> splitIntoFour(const TriangleMesh& mesh, const std::vector<Eigen::Vector3i>& edge_vertex)
{
  std::vector<Eigen::Vector3i> triangles;
  triangles.reserve(4 * mesh.triangles.size());
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
  {
    const Eigen::Vector3i& corner = mesh.triangles[t];
    const Eigen::Vector3i& side = edge_vertex[t];
    triangles.emplace_back(corner[0], side[0], side[2]);
    triangles.emplace_back(side[0], corner[1], side[1]);
    triangles.emplace_back(side[2], side[1], corner[2]);
    triangles.push_back(side);
  }
  return triangles;
}

const Eigen::Vector3d& opposite(const TriangleMesh& mesh, const HalfEdge& use)
{
  const int vertex = mesh.triangles[static_cast<std::size_t>(use.triangle)][(use.side + 2) % 3];
  return mesh.vertices[static_cast<std::size_t>(vertex)];
}

/** Weight of each neighbour of a vertex of valence n in Loop's vertex rule. */
double neighbourWeight(int n)
{
  const double c = 0.375 + 0.25 * std::cos(2.0 * M_PI / n);
  return (0.625 - c * c) / n;
}

TriangleMesh subdivideOnce(const TriangleMesh& mesh, bool smooth)
{
  const std::vector<HalfEdge> half_edges = sortedHalfEdges(mesh);
  TriangleMesh fine;
  fine.vertices = mesh.vertices;
  std::vector<Eigen::Vector3d> neighbour_sum(mesh.vertices.size(), Eigen::Vector3d::Zero());
  std::vector<int> degree(mesh.vertices.size(), 0);
  for (std::size_t begin = 0; begin < half_edges.size(); begin = endOfEdge(half_edges, begin))
  {
    const auto low = static_cast<std::size_t>(half_edges[begin].low);
    const auto high = static_cast<std::size_t>(half_edges[begin].high);
    const Eigen::Vector3d sum = mesh.vertices[low] + mesh.vertices[high];
    const bool inner = endOfEdge(half_edges, begin) - begin == 2;
    fine.vertices.emplace_back(0.5 * sum);
    if (smooth && inner)
      fine.vertices.back() =
          0.375 * sum + 0.125 * (opposite(mesh, half_edges[begin]) + opposite(mesh, half_edges[begin + 1]));
    neighbour_sum[low] += mesh.vertices[high];
    neighbour_sum[high] += mesh.vertices[low];
    ++degree[low];
    ++degree[high];
  }
  if (smooth)
    for (std::size_t v = 0; v < mesh.vertices.size(); ++v)
      if (degree[v] >= 3)
      {
        const double weight = neighbourWeight(degree[v]);
        fine.vertices[v] = (1.0 - degree[v] * weight) * mesh.vertices[v] + weight * neighbour_sum[v];
      }
  fine.triangles = splitIntoFour(mesh, edgeVertices(mesh, half_edges));
  return fine;
}

TriangleMesh subdivide(TriangleMesh mesh, int levels, bool smooth)
{
  for (int level = 0; level < levels; ++level)
    mesh = subdivideOnce(mesh, smooth);
  return mesh;
}

/** Angle-weighted vertex normals; zero at creases. */
std::vector<Eigen::Vector3d> smoothNormals(const TriangleMesh& mesh, double crease_angle)
{
  const std::vector<Eigen::Vector3d> normals = angleWeightedNormals(mesh);
  std::vector<Eigen::Vector3d> smooth = normals;
  const double least = std::cos(crease_angle);
  for (const Eigen::Vector3i& t : mesh.triangles)
  {
    const auto at = [&](int k) -> const Eigen::Vector3d& { return mesh.vertices[static_cast<std::size_t>(t[k])]; };
    const Eigen::Vector3d facet = (at(1) - at(0)).cross(at(2) - at(1)).normalized();
    for (int k = 0; k < 3; ++k)
      if (!(facet.dot(normals[static_cast<std::size_t>(t[k])]) > least))
        smooth[static_cast<std::size_t>(t[k])].setZero();
  }
  return smooth;
}

/** Height of an arc over its chord that leaves one end at a right angle to a normal, against the normal's direction.
 *  @param chord from that end to the other [m] */
double arcHeight(const Eigen::Vector3d& chord, const Eigen::Vector3d& normal)
{
  const double rise = chord.dot(normal);
  const double cosine = std::sqrt(std::max(0.0, 1.0 - rise * rise / chord.squaredNorm()));
  return 0.5 * rise / (1.0 + cosine);
}

}  // namespace

TriangleMesh normalSubdivision(TriangleMesh mesh, int levels, double crease_angle)
{
  for (int level = 0; level < levels; ++level)
  {
    const std::vector<Eigen::Vector3d> normals = smoothNormals(mesh, crease_angle);
    TriangleMesh fine = midpointSubdivision(mesh, 1);
    const std::vector<HalfEdge> half_edges = sortedHalfEdges(mesh);
    std::size_t next = mesh.vertices.size();
    for (std::size_t begin = 0; begin < half_edges.size(); begin = endOfEdge(half_edges, begin), ++next)
    {
      const auto low = static_cast<std::size_t>(half_edges[begin].low);
      const auto high = static_cast<std::size_t>(half_edges[begin].high);
      const Eigen::Vector3d chord = mesh.vertices[high] - mesh.vertices[low];
      const Eigen::Vector3d mean = normals[low] + normals[high];
      if (mean.squaredNorm() > 0.0)
        fine.vertices[next] -=
            0.5 * (arcHeight(chord, normals[low]) + arcHeight(-chord, normals[high])) * mean.normalized();
    }
    mesh = std::move(fine);
  }
  return mesh;
}

TriangleMesh loopSubdivision(TriangleMesh mesh, int levels)
{
  return subdivide(std::move(mesh), levels, true);
}

TriangleMesh midpointSubdivision(TriangleMesh mesh, int levels)
{
  return subdivide(std::move(mesh), levels, false);
}

}  // namespace endovascular_sim::geometry
