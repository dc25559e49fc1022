#include "vessel/repair/fairing.h"

#include <cmath>

namespace endovascular_sim::vessel
{
namespace
{

/** Taubin's factors λ and μ; the pass-band frequency is 1/λ + 1/μ. */
constexpr double kLambda = 0.6307;
constexpr double kMu = -0.6732;

/** Laplacian smoothing step with uniform weights (umbrella operator). */
void laplacianStep(geometry::TriangleMesh& mesh, double factor)
{
  std::vector<Eigen::Vector3d> sum(mesh.vertices.size(), Eigen::Vector3d::Zero());
  std::vector<int> count(mesh.vertices.size(), 0);
  for (const Eigen::Vector3i& t : mesh.triangles)
    for (int k = 0; k < 3; ++k)
    {
      sum[static_cast<std::size_t>(t[k])] += mesh.vertices[static_cast<std::size_t>(t[(k + 1) % 3])];
      ++count[static_cast<std::size_t>(t[k])];
    }
  for (std::size_t v = 0; v < sum.size(); ++v)
    if (count[v] > 0)
      mesh.vertices[v] += factor * (sum[v] / count[v] - mesh.vertices[v]);
}

}  // namespace

void fair(geometry::TriangleMesh& mesh, const std::vector<double>& limits, int rounds)
{
  const std::vector<Eigen::Vector3d> start = mesh.vertices;
  for (int round = 0; round < rounds; ++round)
  {
    laplacianStep(mesh, kLambda);
    laplacianStep(mesh, kMu);
    for (std::size_t v = 0; v < start.size(); ++v)
    {
      const Eigen::Vector3d displacement = mesh.vertices[v] - start[v];
      if (displacement.norm() > limits[v])
        mesh.vertices[v] = start[v] + limits[v] / displacement.norm() * displacement;
    }
  }
}

}  // namespace endovascular_sim::vessel
