#pragma once

#include <string>

#include <Eigen/Geometry>

#include "geometry/triangle_mesh.h"
#include "image/volume.h"
#include "patient/volume/patient_volume.h"

namespace endovascular_sim::patient
{

/** Least spacing of the voxels of a patient made from a CT [m]. Finer images are averaged: a pixel of the projection at
 * rest covers 0.7 mm. */
constexpr double kCtSpacing = 0.8e-3;

/** Densities of a CT in the patient frame.
 *
 *  CT numbers become densities by densityFromHounsfield(), averaged over blocks of voxels up to kCtSpacing. Contrast
 * medium in the lumen becomes blood (replaceByBlood()).
 *
 *  @param patient_from_ct registration: rotation and translation [m]
 *  @param lumen closed mesh of the vessel in the patient frame; may be empty
 *  @param source name of the CT in errors
 *  @throws InputError for an image without Hounsfield units, and if no vertex of the vessel lies inside the CT */
PatientVolume ctVolume(const image::Volume& ct, const Eigen::Isometry3d& patient_from_ct,
                       const geometry::TriangleMesh& lumen, const std::string& source);

}  // namespace endovascular_sim::patient
