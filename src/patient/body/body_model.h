#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "patient/solid/voxeliser.h"
#include "patient/volume/patient_volume.h"
#include "vessel/model/vessel.h"

namespace endovascular_sim::patient
{

/** Version of the body; part of the cache key. Incremented by every change of its voxels. */
constexpr int kBodyVersion = 3;

/** Settings of a procedural body. */
struct BodySettings
{
  double spacing = 1.25e-3;  ///< of the voxels [m]
  std::uint64_t seed = 1;    ///< of texture, vessels of the lungs and gas of the bowel
};

/** Makes a procedural thorax, abdomen and pelvis around a vessel. The lumen is blood; no voxel within two voxels of it
 * contains bone. Equal inputs give equal bytes.
 *  @throws InputError for a spacing outside of 0.5 to 10 mm */
PatientVolume makeBody(const vessel::Vessel& vessel, const BodySettings& settings = {});

/** Map of the tissues around a vessel: labelled solids in the order in which they are drawn. X-ray images take the
 * densities of its tissues (voxelise()), synthetic CT images also the contrast medium in them (phantom::makePhantom()).
 */
struct BodyMap
{
  BodyFrame frame;
  BodyPlan parts;
  std::uint64_t seed = 0;           ///< of the texture
  double spine_displacement = 0.0;  ///< largest one, for the vessel [m]
};

/** @param wall points of the vessel's wall, which the spine avoids; patient frame [m] */
BodyMap bodyMap(const BodyFrame& frame, const std::vector<Eigen::Vector3d>& wall, std::uint64_t seed);

/** Body from the cache, or made and cached.
 *  @param cache_folder as of vessel::loadAnatomy(); empty disables the cache. Damaged entries are rebuilt. A read-only
 * folder is no error. */
PatientVolume loadBody(const vessel::Vessel& vessel, const BodySettings& settings, const std::string& cache_folder);

}  // namespace endovascular_sim::patient
