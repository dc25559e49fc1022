#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "common/progress.h"
#include "image/volume.h"
#include "phantom/tissue.h"
#include "vessel/anatomy/anatomy.h"

namespace endovascular_sim::phantom
{

/** Properties of a synthetic image. */
struct PhantomSettings
{
  image::VolumeGrid grid;
  image::Modality modality = image::Modality::kCt;
  double point_spread = 3e-4;    ///< standard deviation of the Gaussian point spread [m]
  double noise = 25.0;           ///< standard deviation of the noise, in the unit of the values
  double noise_grain = 0.7;      ///< standard deviation of the filter that correlates the noise [voxels]
  double wall_thickness = 6e-4;  ///< [m]
  std::uint64_t seed = 1;        ///< of the noise
  int threads = 0;               ///< 0: number of processors
};

/** Grid of axis-aligned voxels that covers a box.
 *  @param low, high corners of the box, faces of the outermost voxels [m] */
image::VolumeGrid gridOfBox(const Eigen::Vector3d& low, const Eigen::Vector3d& high, const Eigen::Vector3d& spacing);

/** Draws slices of an image without point spread and noise.
 *  @param first index of the first slice
 *  @param slices receives their values in row-major order; as many slices as it has elements */
using SlicePainter = std::function<void(int first, std::vector<std::vector<float>>& slices, int threads)>;

/** Image of painted slices, with point spread and correlated noise. The result does not depend on the number of
 * threads.
 *  @throws InputError for settings that are not finite or out of range */
image::Volume blurredImage(const SlicePainter& painter, const PhantomSettings& settings,
                           const ProgressReport& progress = {});

/** Synthetic CT or MR angiogram of a generated anatomy. The lumen is the inside of the anatomy's implicit vessel, which
 * is therefore the exact truth of a segmentation. A voxel at a border of two tissues holds a mixture by its distance
 * from the border; point spread and correlated noise follow. The result does not depend on the number of threads.
 * Memory beyond that of the result: some slices.
 *  @throws InputError for settings that are not finite or out of range */
image::Volume makePhantom(const vessel::Anatomy& anatomy, const PhantomSettings& settings,
                          const ProgressReport& progress = {});

}  // namespace endovascular_sim::phantom
