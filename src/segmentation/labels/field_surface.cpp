#include "segmentation/labels/field_surface.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <unordered_map>
#include <utility>

#include "segmentation/surface/lattice_surface.h"

namespace endovascular_sim::segmentation
{
namespace
{

constexpr double kLargestMove = 0.35;  ///< onto the zero level [voxels]
constexpr int kNewtonSteps = 3;

/** Field between the voxels by cubic interpolation (E. Catmull, R. Rom, "A class of local interpolating splines",
 * 1974), with its gradient. */
class CubicField
{
public:
  CubicField(const VoxelMask& mask, const std::vector<float>& field) : mask_(mask), field_(field) {}

  /** @param p point in voxels from the first one
   *  @return value and gradient */
  std::pair<double, Eigen::Vector3d> at(const Eigen::Vector3d& p) const
  {
    std::array<Weights, 3> axes;
    for (int axis = 0; axis < 3; ++axis)
      axes[static_cast<std::size_t>(axis)] = weightsOf(p[axis], mask_.size[axis]);
    double value = 0.0;
    Eigen::Vector3d gradient = Eigen::Vector3d::Zero();
    for (std::size_t c = 0; c < 4; ++c)
      for (std::size_t b = 0; b < 4; ++b)
        for (std::size_t a = 0; a < 4; ++a)
        {
          const double f = field_[mask_.offset({axes[0].index[a], axes[1].index[b], axes[2].index[c]})];
          value += f * axes[0].weight[a] * axes[1].weight[b] * axes[2].weight[c];
          gradient += f * Eigen::Vector3d(axes[0].slope[a] * axes[1].weight[b] * axes[2].weight[c],
                                          axes[0].weight[a] * axes[1].slope[b] * axes[2].weight[c],
                                          axes[0].weight[a] * axes[1].weight[b] * axes[2].slope[c]);
        }
    return {value, gradient};
  }

private:
  /** Weights of four voxels along an axis, and their derivatives. */
  struct Weights
  {
    std::array<int, 4> index{};
    std::array<double, 4> weight{};
    std::array<double, 4> slope{};
  };

  static Weights weightsOf(double place, int size)
  {
    const int first = static_cast<int>(std::floor(place)) - 1;
    const double t = place - first - 1;
    Weights weights;
    for (int k = 0; k < 4; ++k)
      weights.index[static_cast<std::size_t>(k)] = std::clamp(first + k, 0, size - 1);
    weights.weight = {0.5 * t * (-1.0 + t * (2.0 - t)), 0.5 * (2.0 + t * t * (-5.0 + 3.0 * t)),
                      0.5 * t * (1.0 + t * (4.0 - 3.0 * t)), 0.5 * t * t * (t - 1.0)};
    weights.slope = {0.5 * (-1.0 + t * (4.0 - 3.0 * t)), 0.5 * t * (-10.0 + 9.0 * t), 0.5 * (1.0 + t * (8.0 - 9.0 * t)),
                     0.5 * t * (3.0 * t - 2.0)};
    return weights;
  }

  const VoxelMask& mask_;
  const std::vector<float>& field_;
};

/** Divides every triangle into four at the middles of its edges. */
geometry::TriangleMesh divided(const geometry::TriangleMesh& mesh)
{
  geometry::TriangleMesh result;
  result.vertices = mesh.vertices;
  result.triangles.reserve(4 * mesh.triangles.size());
  std::unordered_map<std::uint64_t, int> middles;
  middles.reserve(2 * mesh.triangles.size());
  const auto middleOf = [&](int a, int b)
  {
    const auto key = static_cast<std::uint64_t>(std::min(a, b)) << 32U | static_cast<std::uint64_t>(std::max(a, b));
    const auto [entry, is_new] = middles.emplace(key, static_cast<int>(result.vertices.size()));
    if (is_new)
      result.vertices.emplace_back(
          0.5 * (mesh.vertices[static_cast<std::size_t>(a)] + mesh.vertices[static_cast<std::size_t>(b)]));
    return entry->second;
  };
  for (const Eigen::Vector3i& t : mesh.triangles)
  {
    const Eigen::Vector3i m(middleOf(t[0], t[1]), middleOf(t[1], t[2]), middleOf(t[2], t[0]));
    result.triangles.emplace_back(t[0], m[0], m[2]);
    result.triangles.emplace_back(m[0], t[1], m[1]);
    result.triangles.emplace_back(m[2], m[1], t[2]);
    result.triangles.push_back(m);
  }
  return result;
}

/** Moves a point onto the zero level along the gradient, within a bound. */
Eigen::Vector3d onZeroLevel(const CubicField& field, const Eigen::Vector3d& start)
{
  constexpr double kFlat = 1e-3;  // squared gradient without a direction [1/voxel²]
  Eigen::Vector3d p = start;
  for (int step = 0; step < kNewtonSteps; ++step)
  {
    const auto [value, gradient] = field.at(p);
    const double squared = gradient.squaredNorm();
    if (squared < kFlat)
      break;
    p -= value / squared * gradient;
    if (const Eigen::Vector3d move = p - start; move.norm() > kLargestMove)
      p = start + kLargestMove / move.norm() * move;
  }
  return p;
}

}  // namespace

geometry::TriangleMesh fieldSurface(const VoxelMask& mask, const std::vector<float>& field)
{
  geometry::TriangleMesh mesh = divided(latticeSurface(LatticeField(field, mask.size)));
  const CubicField cubic(mask, field);
  for (Eigen::Vector3d& p : mesh.vertices)
    p = mask.first + onZeroLevel(cubic, p).cwiseProduct(mask.spacing);
  return mesh;
}

}  // namespace endovascular_sim::segmentation
