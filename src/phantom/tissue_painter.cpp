#include "phantom/tissue_painter.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "common/numerics/parallel_for.h"
#include "common/units.h"
#include "phantom/tissue.h"
#include "vessel/anatomy/anatomy.h"

namespace endovascular_sim::phantom
{
namespace
{

using patient::BodyPart;
using patient::Tissue;

constexpr int kBlock = 8;  ///< voxels along the edge of a block
/** Bound of the slope of the implicit vessel. */
constexpr double kVesselSlope = 1.15;
constexpr double kSleeve = 2.5e-3;     ///< distance from the lumen up to which fat surrounds a vessel in the body [m]
constexpr double kClearance = 3.5e-3;  ///< least distance of contrast medium in the heart from the lumen [m]
/** Bound of the ratio of the distance that a solid of the body returns inside of it and the true one: that of the axes
 * of its ellipsoids. */
constexpr double kInsideRatio = 2.0;

/** Distance from the surface of a part whose frame has millimetres [m]. */
double distanceTo(const BodyPart& part, const Eigen::Vector3d& p)
{
  return units::kMillimetre * static_cast<double>(part.distance((p / units::kMillimetre).cast<float>()));
}

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
  if (std::optional<PhantomBody> body = phantomBody(anatomy, chains, grid.bounds()))
  {
    densities_ = std::move(body->densities);
    contrast_ = std::move(body->contrast);
    frame_ = body->frame;
    veins_ = cardiacVeins(anatomy, chains);
  }
  plaques_ = calcifiedPlaques(anatomy, chains);
}

double TissuePainter::toContrast(const BodyPart& part, const Eigen::Vector3d& p) const
{
  return units::kMillimetre * frame_.scale * static_cast<double>(part.distance(frame_.fromPatient(p)));
}

TissuePainter::BlockParts TissuePainter::partsOf(const Eigen::Vector3d& centre, double reach) const
{
  BlockParts parts;
  parts.in_body = densities_.has_value();
  parts.value = tissueValue(Tissue::kFat, modality_, centre.z());
  const double border = reach + voxel_;
  const double beside = parts.in_body ? std::max(wall_thickness_, kClearance) : wall_thickness_;
  parts.near_vessel = field_.at(centre).distance < kVesselSlope * (border + beside);
  for (const BodyPart& part : contrast_)
  {
    const double d = toContrast(part, centre);
    if (d > border)
      continue;
    if (d < -kInsideRatio * border && !parts.near_vessel)  // covers the block and everything drawn before
    {
      parts.contrast.clear();
      parts.in_body = false;
      parts.value = tissueValue(part.material.tissue, modality_, centre.z());
      continue;
    }
    parts.contrast.push_back(&part);
  }
  const auto keepNear = [&](const std::vector<BodyPart>& all, std::vector<const BodyPart*>& kept)
  {
    for (const BodyPart& part : all)
      if (distanceTo(part, centre) <= border)
        kept.push_back(&part);
  };
  keepNear(veins_, parts.veins);
  keepNear(plaques_, parts.plaques);
  return parts;
}

void TissuePainter::blend(double& value, double distance, Tissue tissue, double height) const
{
  const double share = std::clamp(0.5 - distance / voxel_, 0.0, 1.0);
  if (share > 0.0)
    value += share * (tissueValue(tissue, modality_, height) - value);
}

double TissuePainter::valueAt(const Eigen::Vector3d& p, const BlockParts& parts) const
{
  const double wall = parts.near_vessel ? field_.at(p).distance : HUGE_VAL;
  double value = parts.value;
  if (parts.in_body)
  {
    value = bodyValue(densities_->interpolate(p), modality_, p.z());
    blend(value, wall - kSleeve, Tissue::kFat, p.z());
  }
  for (const BodyPart* part : parts.contrast)
    blend(value, std::max(toContrast(*part, p), kClearance - wall), part->material.tissue, p.z());
  for (const BodyPart* vein : parts.veins)
    blend(value, distanceTo(*vein, p), vein->material.tissue, p.z());
  if (!parts.near_vessel)
    return value;
  blend(value, wall - wall_thickness_, Tissue::kVesselWall, p.z());
  blend(value, wall, Tissue::kLumen, p.z());
  for (const BodyPart* plaque : parts.plaques)
    blend(value, std::max(distanceTo(*plaque, p), -wall), plaque->material.tissue, p.z());
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
  const bool uniform = !parts.in_body && parts.contrast.empty() && parts.veins.empty() && !parts.near_vessel;
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
