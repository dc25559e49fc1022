#include "segmentation/labels/voxel_mask.h"

#include <algorithm>
#include <cmath>

#include "segmentation/lumen/wide_regions.h"

namespace endovascular_sim::segmentation
{

std::size_t VoxelMask::voxels() const
{
  return static_cast<std::size_t>(std::count(inside.begin(), inside.end(), std::uint8_t{1}));
}

std::vector<float> distancesFrom(const VoxelMask& mask, std::uint8_t value)
{
  constexpr float kFar = 1e6F;  // m²
  std::vector<float> distances(mask.inside.size());
  for (std::size_t n = 0; n < distances.size(); ++n)
    distances[n] = mask.inside[n] == value ? 0.0F : kFar;
  squaredDistances(distances, mask.size, mask.spacing);
  for (float& distance : distances)
    distance = std::sqrt(distance);
  return distances;
}

}  // namespace endovascular_sim::segmentation
