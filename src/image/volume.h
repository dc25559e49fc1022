#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "image/volume_grid.h"

namespace endovascular_sim::image
{

/** Meaning of the values of a volume. */
enum class Modality : std::uint32_t
{
  kCt = 1,      ///< Hounsfield units
  kOther = 2,   ///< e.g. magnetic resonance: no unit
  kLabels = 3,  ///< chosen labels of a label map, numbered 1, 2, … in the order of the choice; 0 elsewhere
};

/** Image of a patient: a value at each voxel of a grid. */
struct Volume
{
  VolumeGrid grid;
  Modality modality = Modality::kCt;
  double scale = 1.0;                ///< value = scale · stored value
  std::vector<std::int16_t> stored;  ///< one per voxel, i fastest

  double at(int i, int j, int k) const { return scale * stored[grid.offset(i, j, k)]; }
};

}  // namespace endovascular_sim::image
