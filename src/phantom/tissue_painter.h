#pragma once

#include <optional>
#include <vector>

#include "image/volume.h"
#include "phantom/phantom_body.h"
#include "vessel/anatomy/implicit_vessel.h"

namespace endovascular_sim::phantom
{

/** Draws the tissues of a body, contrast medium in the chambers of the heart, veins, the wall and the lumen of its
 * vessels, and plaques into slices of an image. */
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
    bool in_body = true;                             ///< false: one tissue covers the whole block
    double value = 0.0;                              ///< of that tissue
    std::vector<const patient::BodyPart*> contrast;  ///< parts of the body with a surface near the block
    bool near_vessel = false;
    std::vector<const patient::BodyPart*> veins;
    std::vector<const patient::BodyPart*> plaques;
  };

  BlockParts partsOf(const Eigen::Vector3d& centre, double reach) const;
  /** Distance from the surface of a part of the body [m]. */
  double toContrast(const patient::BodyPart& part, const Eigen::Vector3d& p) const;
  double valueAt(const Eigen::Vector3d& p, const BlockParts& parts) const;
  void blend(double& value, double distance, patient::Tissue tissue, double height) const;
  void paintBlock(int first, int column, int row, std::vector<std::vector<float>>& slices) const;

  image::VolumeGrid grid_;
  image::Modality modality_;
  double wall_thickness_;
  double voxel_;  ///< width of the border between two tissues [m]
  vessel::ImplicitVessel field_;
  std::optional<patient::DensityVolume> densities_;  ///< of the body; empty: fat
  std::vector<patient::BodyPart> contrast_;
  patient::BodyFrame frame_;  ///< of the parts with contrast medium
  std::vector<patient::BodyPart> veins_;
  std::vector<patient::BodyPart> plaques_;
};

}  // namespace endovascular_sim::phantom
