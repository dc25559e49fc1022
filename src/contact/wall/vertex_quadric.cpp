#include "contact/wall/vertex_quadric.h"

#include <algorithm>
#include <cstddef>

#include <Eigen/Cholesky>
#include <Eigen/Geometry>

namespace endovascular_sim::contact
{
namespace
{

using Vector5d = Eigen::Matrix<double, 5, 1>;
using Matrix5d = Eigen::Matrix<double, 5, 5>;

constexpr int kRounds = 5;                 // of fitting, each in the frame of the last normal
constexpr double kRidge = 1e-5;            // of the normal equations, for vertices with few or aligned neighbours
constexpr std::size_t kFewNeighbours = 5;  // fewer do not determine a quadric: their neighbours are added

/** Vectors from a vertex to its neighbours, to those of the second ring too where the first has too few [m]. */
std::vector<Eigen::Vector3d> neighbourhood(const Wall& wall, int vertex)
{
  std::vector<int> ring = {vertex};
  std::size_t begin = 0;
  do
  {
    const std::size_t end = ring.size();
    for (; begin < end; ++begin)
      for (int e : wall.vertex_edges[ring[begin]])
      {
        const int other = wall.edges[e].otherEnd(ring[begin]);
        if (std::find(ring.begin(), ring.end(), other) == ring.end())
          ring.push_back(other);
      }
    if (begin == ring.size())
      break;
  } while (ring.size() < kFewNeighbours + 1);
  std::vector<Eigen::Vector3d> from;
  for (std::size_t k = 1; k < ring.size(); ++k)
    from.emplace_back(wall.vertices[ring[k]] - wall.vertices[vertex]);
  return from;
}

/** Curvature along the normal that makes the quadric exact for spheres and cylinders: that of the dominant curvature.
 *  @param k curvature tensor in the tangent plane */
double normalBend(const Eigen::Matrix2d& k)
{
  const Eigen::Matrix2d square = k * k;
  const double squares = square.trace();
  return squares > 0.0 ? (square * k).trace() / squares : 0.0;
}

/** One weighted fit of slopes and curvature in the frame of the present normal; updates the quadric. */
void refine(const std::vector<Eigen::Vector3d>& from, VertexQuadric& quadric)
{
  const Eigen::Vector3d n = quadric.normal;
  const Eigen::Vector3d t1 = n.unitOrthogonal();
  const Eigen::Vector3d t2 = n.cross(t1);
  const double along_normal = n.dot(quadric.bend * n);
  Matrix5d matrix = Matrix5d::Zero();
  Vector5d rhs = Vector5d::Zero();
  double length = 0.0;
  for (const Eigen::Vector3d& d : from)
    length += d.norm() / static_cast<double>(from.size());
  for (const Eigen::Vector3d& d : from)
  {
    const double u = d.dot(t1) / length;
    const double v = d.dot(t2) / length;
    const double z = d.dot(n) / length;
    Vector5d row;
    row << u, v, 0.5 * u * u, u * v, 0.5 * v * v;
    const double weight = length * length / d.squaredNorm();
    matrix += weight * row * row.transpose();
    rhs += weight * (z - 0.5 * along_normal * length * z * z) * row;
  }
  matrix.diagonal().array() += kRidge * matrix.trace();
  const Vector5d fit = matrix.ldlt().solve(rhs);
  Eigen::Matrix2d curvature;
  curvature << fit[2], fit[3], fit[3], fit[4];
  curvature /= length;
  quadric.normal = (n - fit[0] * t1 - fit[1] * t2).normalized();
  // The tangents follow the normal by the smallest rotation.
  const Eigen::Quaterniond turn = Eigen::Quaterniond::FromTwoVectors(n, quadric.normal);
  Eigen::Matrix<double, 3, 2> tangents;
  tangents << turn * t1, turn * t2;
  quadric.bend =
      tangents * curvature * tangents.transpose() + normalBend(curvature) * quadric.normal * quadric.normal.transpose();
}

}  // namespace

std::vector<VertexQuadric> fitVertexQuadrics(const Wall& wall)
{
  std::vector<VertexQuadric> quadrics(wall.vertices.size());
  for (std::size_t v = 0; v < quadrics.size(); ++v)
  {
    quadrics[v].normal = wall.vertex_normals[v];
    const std::vector<Eigen::Vector3d> from = neighbourhood(wall, static_cast<int>(v));
    for (int round = 0; round < kRounds && !from.empty(); ++round)
      refine(from, quadrics[v]);
  }
  return quadrics;
}

std::vector<double> quadricDisagreement(const Wall& wall, const std::vector<VertexQuadric>& quadrics)
{
  std::vector<double> sum(quadrics.size(), 0.0);
  for (const WallEdge& edge : wall.edges)
    for (int side = 0; side < 2; ++side)
    {
      const int here = edge.vertices[side];
      const int there = edge.vertices[1 - side];
      const Eigen::Vector3d predicted =
          quadrics[here].gradient(wall.vertices[there] - wall.vertices[here]).normalized();
      const double angle = angleBetween(predicted, quadrics[there].normal);
      sum[here] += 0.5 * angle;
      sum[there] += 0.5 * angle;
    }
  for (std::size_t v = 0; v < sum.size(); ++v)
    sum[v] /= std::max<std::size_t>(1, wall.vertex_edges[v].size());
  return sum;
}

}  // namespace endovascular_sim::contact
