#pragma once

#include <optional>
#include <vector>

#include "image/volume_grid.h"
#include "phantom/tissue.h"
#include "vessel/anatomy/implicit_vessel.h"

namespace endovascular_sim::phantom
{

/** Draws the tissues of a body, the wall and the lumen of its vessels, and plaques into slices of an image. */
class TissuePainter
{
public:
  TissuePainter(const vessel::Anatomy& anatomy, const image::VolumeGrid& grid, image::Modality modality,
                double wall_thickness);

  /** Draws slices, on several threads.
   *  @param first index of the first slice
   *  @param slices receives its values, in row-major order; as many slices as it has elements */
  void paint(int first, std::vector<std::vector<float>>& slices, int threads) const;

private:
  /** Parts that a block of voxels meets, in the order of drawing. */
  struct BlockParts
  {
    bool in_body = true;                  ///< false: one tissue covers the whole block
    double value = 0.0;                   ///< of that tissue
    std::vector<const TissuePart*> body;  ///< parts with a surface near the block
    bool near_vessel = false;
    std::vector<const TissuePart*> plaques;
  };

  BlockParts partsOf(const Eigen::Vector3d& centre, double reach) const;
  double bodyAt(const Eigen::Vector3d& p) const;
  double valueAt(const Eigen::Vector3d& p, const BlockParts& parts) const;
  void blend(double& value, double distance, Tissue tissue, double height) const;
  void paintBlock(int first, int column, int row, std::vector<std::vector<float>>& slices) const;

  image::VolumeGrid grid_;
  image::Modality modality_;
  double wall_thickness_;
  double voxel_;  ///< width of the border between two tissues [m]
  vessel::ImplicitVessel field_;
  std::optional<fluoroscopy::DensityVolume> body_;  ///< empty: fat
  std::vector<TissuePart> heart_;
  std::vector<TissuePart> plaques_;
};

}  // namespace endovascular_sim::phantom
