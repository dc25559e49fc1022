#include "geometry/surface_samples.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include <Eigen/Geometry>

namespace endovascular_sim::geometry
{

std::vector<TriangleCorners> bisectTriangle(const TriangleCorners& triangle, double longest)
{
  std::vector<TriangleCorners> parts;
  std::vector<TriangleCorners> open{triangle};
  while (!open.empty())
  {
    const TriangleCorners t = open.back();
    open.pop_back();
    std::size_t side = 0;
    for (std::size_t k = 1; k < 3; ++k)
      if ((t[(k + 1) % 3] - t[k]).squaredNorm() > (t[(side + 1) % 3] - t[side]).squaredNorm())
        side = k;
    const Eigen::Vector3d& a = t[side];
    const Eigen::Vector3d& b = t[(side + 1) % 3];
    const Eigen::Vector3d& c = t[(side + 2) % 3];
    if (!((b - a).cross(c - a).norm() > 0.0))
      continue;
    if ((b - a).norm() <= longest)
    {
      parts.push_back({a, b, c});
      continue;
    }
    const Eigen::Vector3d middle = 0.5 * (a + b);
    open.push_back({a, middle, c});
    open.push_back({middle, b, c});
  }
  return parts;
}

std::vector<SurfaceSample> sampleSurface(const TriangleMesh& mesh, double spacing, std::size_t first, std::size_t last)
{
  std::vector<SurfaceSample> samples;
  for (std::size_t t = first; t < std::min(last, mesh.triangles.size()); ++t)
  {
    const auto at = [&](int k) { return mesh.vertices[static_cast<std::size_t>(mesh.triangles[t][k])]; };
    for (const TriangleCorners& part : bisectTriangle({at(0), at(1), at(2)}, spacing))
    {
      const Eigen::Vector3d twice = (part[1] - part[0]).cross(part[2] - part[0]);
      samples.push_back({(part[0] + part[1] + part[2]) / 3.0, twice.normalized(), 0.5 * twice.norm()});
    }
  }
  return samples;
}

Deviation deviationOf(const std::vector<SurfaceSample>& samples, const std::vector<double>& distances, double tolerance)
{
  Deviation deviation;
  double area = 0.0;
  for (std::size_t k = 0; k < samples.size(); ++k)
  {
    area += samples[k].area;
    deviation.rms += samples[k].area * distances[k] * distances[k];
    if (distances[k] > tolerance)
      deviation.beyond += samples[k].area;
    if (distances[k] > deviation.largest)
    {
      deviation.largest = distances[k];
      deviation.location = samples[k].point;
    }
  }
  if (!(area > 0.0))
    return deviation;
  deviation.rms = std::sqrt(deviation.rms / area);
  std::vector<std::size_t> order(samples.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::sort(order.begin(), order.end(),
            [&](std::size_t a, std::size_t b)
            { return distances[a] < distances[b] || (distances[a] == distances[b] && a < b); });
  double passed = 0.0;
  for (std::size_t k : order)
  {
    passed += samples[k].area;
    deviation.p99 = distances[k];
    if (passed >= 0.99 * area)
      break;
  }
  return deviation;
}

}  // namespace endovascular_sim::geometry
