#pragma once

#include <memory>
#include <string>
#include <vector>

#include "fluoroscopy/patient/progressive_projection.h"
#include "patient/volume/patient_volume.h"
#include "scene/model/scene.h"
#include "vessel/model/vessel.h"

namespace endovascular_sim::simulation
{

/** Resolution of single images: complete in the first frame, and exact in a moving patient. */
constexpr fluoroscopy::ProgressiveResolution kStillResolution{512, 512, 1 << 20, fluoroscopy::MotionSampling::kExact};

/** Resolution of a sequence: 128² while C-arm or table move, 256² within 0.9 s of rest.
 *  @param rate frame rate [Hz] */
fluoroscopy::ProgressiveResolution sequenceResolution(double rate);

/** Patient of a scene, and notes for the log. */
struct XRayPatient
{
  std::unique_ptr<fluoroscopy::Patient> patient;  ///< null: the scene has no patient
  std::vector<std::string> notes;
};

/** Voxels of the patient of a scene: its procedural body, made once and cached, or its CT; null without a patient.
 *  @param vessel vessel at rest, in the patient frame
 *  @throws InputError if the CT is missing or damaged, or lies beside the vessel */
patient::PatientVolume patientVolume(const scene::Scene& scene, const vessel::Vessel& vessel);

/** Loads the patient of a scene for a sequence of images. Parameters and errors as of patientVolume(). */
XRayPatient loadPatient(const scene::Scene& scene, const vessel::Vessel& vessel,
                        const fluoroscopy::ProgressiveResolution& resolution);

}  // namespace endovascular_sim::simulation
