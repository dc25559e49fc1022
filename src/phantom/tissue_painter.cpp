#include "phantom/tissue_painter.h"

#include <algorithm>
#include <cmath>

#include "common/numerics/parallel_for.h"
#include "phantom/body.h"
#include "vessel/anatomy/anatomy.h"

namespace endovascular_sim::phantom
{
namespace
{

constexpr int kBlock = 8;  ///< voxels along the edge of a block
/** Bound of the slope of the implicit vessel. */
constexpr double kVesselSlope = 1.15;
constexpr double kSleeve = 2.5e-3;  ///< distance from the lumen up to which fat surrounds a vessel in the body [m]

}  // namespace

TissuePainter::TissuePainter(const vessel::Anatomy& anatomy, const image::VolumeGrid& grid, image::Modality modality,
                             double wall_thickness)
  : grid_(grid),
    modality_(modality),
    wall_thickness_(wall_thickness),
    voxel_(std::cbrt(grid.spacing.prod())),
    field_(anatomy, vessel::sampleChains(anatomy))
{
  const std::vector<vessel::AnatomyChain> chains = vessel::sampleChains(anatomy);
  body_ = bodyDensities(anatomy, chains, grid.bounds());
  heart_ = heartParts(anatomy, chains);
  plaques_ = calcifiedPlaques(anatomy, chains);
}

TissuePainter::BlockParts TissuePainter::partsOf(const Eigen::Vector3d& centre, double reach) const
{
  BlockParts parts;
  parts.in_body = body_.has_value();
  parts.value = tissueValue(Tissue::kFat, modality_, centre.z());
  const double border = reach + voxel_;
  for (const TissuePart& part : heart_)
  {
    const double d = part.distance(centre);
    if (d > border)
      continue;
    if (d < -border)  // covers the block and everything drawn before
    {
      parts.body.clear();
      parts.in_body = false;
      parts.value = tissueValue(part.tissue, modality_, centre.z());
    }
    else
      parts.body.push_back(&part);
  }
  const double beside = (parts.in_body ? std::max(wall_thickness_, kSleeve) : wall_thickness_) + voxel_;
  parts.near_vessel = field_.at(centre).distance < kVesselSlope * (reach + beside);
  for (const TissuePart& plaque : plaques_)
    if (plaque.distance(centre) <= border)
      parts.plaques.push_back(&plaque);
  return parts;
}

void TissuePainter::blend(double& value, double distance, Tissue tissue, double height) const
{
  const double share = std::clamp(0.5 - distance / voxel_, 0.0, 1.0);
  if (share > 0.0)
    value += share * (tissueValue(tissue, modality_, height) - value);
}

double TissuePainter::bodyAt(const Eigen::Vector3d& p) const
{
  return bodyValue(body_->interpolate(p), modality_, p.z());
}

double TissuePainter::valueAt(const Eigen::Vector3d& p, const BlockParts& parts) const
{
  const double wall = parts.near_vessel ? field_.at(p).distance : HUGE_VAL;
  double value = parts.in_body ? bodyAt(p) : parts.value;
  if (parts.in_body)
    blend(value, wall - kSleeve, Tissue::kFat, p.z());
  for (const TissuePart* part : parts.body)
    blend(value, part->distance(p), part->tissue, p.z());
  if (!parts.near_vessel)
    return value;
  blend(value, wall - wall_thickness_, Tissue::kWall, p.z());
  blend(value, wall, Tissue::kLumen, p.z());
  for (const TissuePart* plaque : parts.plaques)
    blend(value, std::max(plaque->distance(p), -wall), plaque->tissue, p.z());
  return value;
}

void TissuePainter::paintBlock(int first, int column, int row, std::vector<std::vector<float>>& slices) const
{
  const Eigen::Vector3i begin(column, row, first);
  const Eigen::Vector3i end =
      (begin + Eigen::Vector3i(kBlock, kBlock, static_cast<int>(slices.size()))).cwiseMin(grid_.size);
  const Eigen::Vector3d middle = 0.5 * (begin + end - Eigen::Vector3i::Ones()).cast<double>();
  const double reach = 0.5 * (end - begin).cast<double>().cwiseProduct(grid_.spacing).norm();
  const BlockParts parts = partsOf(grid_.position(middle), reach);
  const bool uniform = !parts.in_body && parts.body.empty() && !parts.near_vessel;
  for (int k = begin.z(); k < end.z(); ++k)
  {
    std::vector<float>& slice = slices[static_cast<std::size_t>(k - first)];
    for (int j = begin.y(); j < end.y(); ++j)
      for (int i = begin.x(); i < end.x(); ++i)
        slice[grid_.offset(i, j, 0)] =
            static_cast<float>(uniform ? parts.value : valueAt(grid_.position(Eigen::Vector3d(i, j, k)), parts));
  }
}

void TissuePainter::paint(int first, std::vector<std::vector<float>>& slices, int threads) const
{
  const std::size_t across = grid_.offset(0, 0, 1);
  for (std::vector<float>& slice : slices)
    slice.resize(across);
  const int columns = (grid_.size.x() + kBlock - 1) / kBlock;
  const int rows = (grid_.size.y() + kBlock - 1) / kBlock;
  parallelFor(static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows), threads,
              [&](std::size_t block)
              {
                const int b = static_cast<int>(block);
                paintBlock(first, kBlock * (b % columns), kBlock * (b / columns), slices);
              });
}

}  // namespace endovascular_sim::phantom
