#include "simulation/x_ray_patient.h"

#include <algorithm>
#include <utility>

#include "image/volume_file.h"
#include "patient/body/body_model.h"
#include "patient/volume/ct_volume.h"
#include "vessel/anatomy/anatomy_mesh.h"

namespace endovascular_sim::simulation
{

patient::PatientVolume patientVolume(const scene::Scene& scene, const vessel::Vessel& vessel)
{
  if (!scene.fluoroscopy || !scene.fluoroscopy->patient)
    return {};
  const scene::PatientScene& patient = *scene.fluoroscopy->patient;
  if (patient.body)
    return patient::loadBody(vessel, {}, vessel::anatomyCacheFolder());
  const Eigen::Isometry3d of_mesh = scene.vessel ? scene.vessel->transform : Eigen::Isometry3d::Identity();
  return patient::ctVolume(image::readVolume(patient.ct), patient.patient_from_ct.value_or(of_mesh), vessel.mesh,
                           patient.ct);
}

fluoroscopy::ProgressiveResolution sequenceResolution(double rate)
{
  constexpr double kTimeToRefine = 0.9;  // s
  fluoroscopy::ProgressiveResolution resolution;
  const int frames = std::max(1, static_cast<int>(kTimeToRefine * rate) - 1);
  const int rows = (resolution.at_rest + frames - 1) / frames;
  resolution.rays_per_frame = rows * resolution.at_rest;
  return resolution;
}

XRayPatient loadPatient(const scene::Scene& scene, const vessel::Vessel& vessel,
                        const fluoroscopy::ProgressiveResolution& resolution)
{
  patient::PatientVolume volume = patientVolume(scene, vessel);
  if (!volume.volume)
    return {};
  return {std::make_unique<fluoroscopy::ProgressiveProjection>(*volume.volume, resolution), std::move(volume.notes)};
}

}  // namespace endovascular_sim::simulation
