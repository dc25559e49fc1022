#include "segmentation/labels/mask_border.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include <Eigen/Eigenvalues>

#include "segmentation/labels/mask_topology.h"

namespace endovascular_sim::segmentation
{
namespace
{

constexpr double kAsWide = 0.7;      ///< least width of an end, relative to the vessel behind it
constexpr double kElongated = 3.0;   ///< ratio of the axes of a patch along the border
constexpr double kContinued = 1.2;   ///< length of a continuation, in radii
constexpr int kEmptyLayers = 2;      ///< behind a continuation
constexpr std::size_t kFewest = 4U;  ///< voxels of an end

/** Outermost layer of an image. */
struct Border
{
  int axis = 0;
  bool is_upper = false;
};

/** Image without its margin. */
VoxelMask withoutMargin(const VoxelMask& mask, int margin)
{
  VoxelMask image(mask.size - Eigen::Vector3i::Constant(2 * margin), mask.spacing,
                  mask.first + static_cast<double>(margin) * mask.spacing);
  for (std::size_t n = 0; n < image.inside.size(); ++n)
    image.inside[n] = mask.inside[mask.offset(image.voxelOf(n) + Eigen::Vector3i::Constant(margin))];
  return image;
}

/** Layer of an image as a mask of one voxel in depth. */
VoxelMask layerOf(const VoxelMask& image, const Border& border, Eigen::Vector3i& from)
{
  Eigen::Vector3i size = image.size;
  size[border.axis] = 1;
  from = Eigen::Vector3i::Zero();
  from[border.axis] = border.is_upper ? image.size[border.axis] - 1 : 0;
  VoxelMask layer(size, image.spacing, image.first + from.cast<double>().cwiseProduct(image.spacing));
  for (std::size_t n = 0; n < layer.inside.size(); ++n)
    layer.inside[n] = image.inside[image.offset(from + layer.voxelOf(n))];
  return layer;
}

/** Patch of a layer. */
struct Patch
{
  std::vector<std::size_t> voxels;  ///< of the layer
  Eigen::Vector3d centre = Eigen::Vector3d::Zero();
  double inscribed = 0.0;   ///< radius of the largest circle [m]
  double elongation = 1.0;  ///< ratio of its axes
};

std::vector<Patch> patchesOf(const VoxelMask& layer)
{
  std::vector<int> component;
  std::vector<Patch> patches(componentsOf(layer, 1, component).size());
  const std::vector<float> distance = distancesFrom(layer, 0);
  for (std::size_t n = 0; n < component.size(); ++n)
    if (component[n] >= 0)
    {
      Patch& patch = patches[static_cast<std::size_t>(component[n])];
      patch.voxels.push_back(n);
      patch.centre += layer.centreOf(n);
      patch.inscribed = std::max(patch.inscribed, static_cast<double>(distance[n]));
    }
  for (Patch& patch : patches)
  {
    const auto count = static_cast<double>(patch.voxels.size());
    patch.centre /= count;
    Eigen::Matrix3d moments = Eigen::Matrix3d::Zero();
    for (const std::size_t n : patch.voxels)
    {
      const Eigen::Vector3d p = layer.centreOf(n) - patch.centre;
      moments += p * p.transpose() / count;
    }
    const Eigen::Vector3d values = Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(moments).eigenvalues();
    // The extent of a voxel adds to both moments.
    const double voxel = std::pow(layer.spacing.minCoeff(), 2) / 12.0;
    patch.elongation = std::sqrt((values[2] + voxel) / (std::max(values[1], 0.0) + voxel));
  }
  return patches;
}

/** Radius of the vessel behind a patch: the largest depth within two radii of the patch. */
double radiusBehind(const VoxelMask& image, const std::vector<float>& depth, const VoxelMask& layer, const Patch& patch,
                    const Border& border, const Eigen::Vector3i& from)
{
  const int layers = std::min(image.size[border.axis] - 1,
                              static_cast<int>(std::ceil(2.0 * patch.inscribed / image.spacing[border.axis])));
  double radius = 0.0;
  for (const std::size_t n : patch.voxels)
  {
    Eigen::Vector3i voxel = from + layer.voxelOf(n);
    for (int k = 0; k <= layers; ++k)
    {
      if (const std::size_t at = image.offset(voxel); image.inside[at] != 0)
        radius = std::max(radius, static_cast<double>(depth[at]));
      voxel[border.axis] += border.is_upper ? -1 : 1;
    }
  }
  return radius;
}

/** Continuation of a patch beyond the border. */
struct Continuation
{
  Border border;
  std::vector<Eigen::Vector3i> voxels;  ///< of the outermost layer, in the image
  int layers = 0;
  Eigen::Vector3d course = Eigen::Vector3d::Zero();  ///< shift per layer [voxels]
  BorderEnd end;
};

/** Course of a vessel at its end: shift of its centre per layer, towards the border [voxels]. The centre of a layer is
 * that of its voxels near the centre of the layer before. */
Eigen::Vector3d courseOf(const VoxelMask& image, const Patch& patch, const Border& border, double radius)
{
  constexpr double kSteepest = 1.5;  // beyond, the border cuts the vessel lengthwise
  const Eigen::Vector3d outermost = (patch.centre - image.first).cwiseQuotient(image.spacing);
  const int layers =
      std::min(image.size[border.axis] - 1, static_cast<int>(std::ceil(1.5 * radius / image.spacing[border.axis])));
  Eigen::Vector3d centre = outermost;
  for (int k = 1; k <= layers; ++k)
  {
    centre[border.axis] += border.is_upper ? -1.0 : 1.0;
    const Eigen::Vector3d reach = (1.5 * radius * image.spacing.cwiseInverse()).array() + 1.0;
    Eigen::Vector3i low = (centre - reach).array().floor().max(0.0).cast<int>();
    Eigen::Vector3i high = (centre + reach).array().ceil().min(image.size.array().cast<double>() - 1.0).cast<int>();
    low[border.axis] = high[border.axis] = static_cast<int>(std::lround(centre[border.axis]));
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    double count = 0.0;
    for (int z = low.z(); z <= high.z(); ++z)
      for (int y = low.y(); y <= high.y(); ++y)
        for (int x = low.x(); x <= high.x(); ++x)
          if (image.at({x, y, z}))
          {
            sum += Eigen::Vector3d(x, y, z);
            count += 1.0;
          }
    if (count == 0.0)
      return Eigen::Vector3d::Zero();
    centre = sum / count;
  }
  Eigen::Vector3d course = (outermost - centre) / std::max(1, layers);
  course[border.axis] = 0.0;
  const double steepness = course.cwiseProduct(image.spacing).norm() / image.spacing[border.axis];
  return steepness > kSteepest ? Eigen::Vector3d(kSteepest / steepness * course) : course;
}

Continuation continuationOf(const VoxelMask& image, const VoxelMask& layer, const Patch& patch, const Border& border,
                            const Eigen::Vector3i& from)
{
  Continuation result;
  result.border = border;
  const double depth = layer.spacing[border.axis];
  const double area = static_cast<double>(patch.voxels.size()) * layer.voxelVolume() / depth;
  BorderEnd& end = result.end;
  end.radius = std::sqrt(area / M_PI);
  end.outward = (border.is_upper ? 1.0 : -1.0) * Eigen::Vector3d::Unit(border.axis);
  end.point = patch.centre + 0.5 * depth * end.outward;
  result.layers = static_cast<int>(std::ceil(kContinued * end.radius / depth)) + 1;
  double widest = 0.0;
  for (const std::size_t n : patch.voxels)
  {
    result.voxels.push_back(from + layer.voxelOf(n));
    widest = std::max(widest, (layer.centreOf(n) - patch.centre).norm());
  }
  result.course = courseOf(image, patch, border, end.radius);
  end.reach =
      std::hypot(widest + result.layers * result.course.cwiseProduct(layer.spacing).norm(), result.layers * depth) +
      3.0 * layer.spacing.maxCoeff();
  return result;
}

}  // namespace

VoxelMask padded(const VoxelMask& mask, int margin)
{
  VoxelMask result(mask.size + Eigen::Vector3i::Constant(2 * margin), mask.spacing,
                   mask.first - static_cast<double>(margin) * mask.spacing);
  for (std::size_t n = 0; n < mask.inside.size(); ++n)
    result.inside[result.offset(mask.voxelOf(n) + Eigen::Vector3i::Constant(margin))] = mask.inside[n];
  return result;
}

std::vector<BorderEnd> continueBeyondBorder(VoxelMask& mask, int margin, std::vector<Eigen::Vector3d>& touches)
{
  const VoxelMask image = withoutMargin(mask, margin);
  const std::vector<float> depth = distancesFrom(image, 0);
  std::vector<Continuation> continuations;
  int layers = 0;
  for (int side = 0; side < 6; ++side)
  {
    const Border border{side / 2, side % 2 == 1};
    Eigen::Vector3i from;
    const VoxelMask layer = layerOf(image, border, from);
    for (const Patch& patch : patchesOf(layer))
    {
      const double behind = radiusBehind(image, depth, layer, patch, border, from);
      if (patch.voxels.size() < kFewest || patch.inscribed < kAsWide * behind || patch.elongation > kElongated)
      {
        touches.push_back(patch.centre);
        continue;
      }
      continuations.push_back(continuationOf(image, layer, patch, border, from));
      const double aside = continuations.back().layers * continuations.back().course.cwiseAbs().maxCoeff();
      layers = std::max({layers, continuations.back().layers, static_cast<int>(std::ceil(aside))});
    }
  }
  std::vector<BorderEnd> ends;
  const int wide = layers + kEmptyLayers;
  mask = padded(image, wide);
  for (const Continuation& continuation : continuations)
  {
    ends.push_back(continuation.end);
    const int step = continuation.border.is_upper ? 1 : -1;
    for (const Eigen::Vector3i& voxel : continuation.voxels)
      for (int k = 1; k <= continuation.layers; ++k)
      {
        Eigen::Vector3i beyond = voxel + (k * continuation.course).array().round().cast<int>().matrix();
        beyond[continuation.border.axis] += k * step;
        mask.inside[mask.offset(beyond + Eigen::Vector3i::Constant(wide))] = 1;
      }
  }
  return ends;
}

}  // namespace endovascular_sim::segmentation
