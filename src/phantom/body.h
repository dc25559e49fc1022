#pragma once

#include <optional>
#include <vector>

#include <Eigen/Geometry>

#include "fluoroscopy/patient/volume/density_volume.h"
#include "phantom/tissue.h"
#include "vessel/anatomy/anatomy.h"

namespace endovascular_sim::phantom
{

/** Body around the vessels of an anatomy, that of its X-ray images (fluoroscopy::drawBody()), without the vessels.
 * Empty for an anatomy without the landmarks that place the body: it lies in fat.
 *  @param box extent of the image [m] */
std::optional<fluoroscopy::DensityVolume> bodyDensities(const vessel::Anatomy& anatomy,
                                                        const std::vector<vessel::AnatomyChain>& chains,
                                                        const Eigen::AlignedBox3d& box);

/** Parts of a CT angiogram that the body of X-ray images lacks, for config/anatomies/plain.yaml only: the chambers of
 * the heart with contrast medium in epicardial fat, and veins beside the left coronary arteries. */
std::vector<TissuePart> heartParts(const vessel::Anatomy& anatomy, const std::vector<vessel::AnatomyChain>& chains);

/** Calcified plaques: balls of 0.9 mm at the wall of the coronary arteries, every 17 mm. They extend outwards only; the
 *  lumen is not part of them. */
std::vector<TissuePart> calcifiedPlaques(const vessel::Anatomy& anatomy,
                                         const std::vector<vessel::AnatomyChain>& chains);

}  // namespace endovascular_sim::phantom
