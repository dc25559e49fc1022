#pragma once

#include <optional>
#include <vector>

#include <Eigen/Geometry>

#include "patient/body/body_model.h"
#include "patient/volume/density_volume.h"
#include "vessel/anatomy/anatomy.h"

namespace endovascular_sim::phantom
{

/** Body around the vessels of an anatomy, that of its X-ray images, without the vessels. */
struct PhantomBody
{
  patient::DensityVolume densities;
  /** Parts with contrast medium, in the order in which they are drawn over the densities. */
  std::vector<patient::BodyPart> contrast;
  patient::BodyFrame frame;  ///< of these parts
};

/** Empty for an anatomy without the landmarks that place the body: it lies in fat.
 *  @param box extent of the image [m] */
std::optional<PhantomBody> phantomBody(const vessel::Anatomy& anatomy, const std::vector<vessel::AnatomyChain>& chains,
                                       const Eigen::AlignedBox3d& box);

/** Veins of 2.5 mm beside the left coronary arteries, winding about them at 0.5 to 1.2 mm from the wall, in the frame
 * of the anatomy [mm]. */
std::vector<patient::BodyPart> cardiacVeins(const vessel::Anatomy& anatomy,
                                            const std::vector<vessel::AnatomyChain>& chains);

/** Calcified plaques: balls of 0.9 mm at the wall of the coronary arteries, every 17 mm, in the frame of the anatomy
 * [mm]. They extend outwards only; the lumen is not part of them. */
std::vector<patient::BodyPart> calcifiedPlaques(const vessel::Anatomy& anatomy,
                                                const std::vector<vessel::AnatomyChain>& chains);

}  // namespace endovascular_sim::phantom
