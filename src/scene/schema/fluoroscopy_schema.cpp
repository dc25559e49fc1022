#include <cmath>

#include "scene/schema/scene_schema.h"

namespace endovascular_sim::scene
{
namespace
{

/** Registration of a CT: rotation, or head and left, and translation. */
void visitRegistration(yaml::Fields& fields, PatientScene& patient)
{
  bool given = !fields.reading();
  for (const char* key : {"rotation", "head", "left", "translation"})
    given = given || fields.has(key);
  if (!given)
    return;
  Eigen::Isometry3d transform = patient.patient_from_ct.value_or(Eigen::Isometry3d::Identity());
  visitRotation(fields, transform);
  Eigen::Vector3d translation = transform.translation();
  fields.vector3("translation", translation, quantities::kPosition);
  transform.translation() = translation;
  patient.patient_from_ct = transform;
}

void visitPatient(yaml::Fields& fields, PatientScene& patient)
{
  if (fields.reading() ? fields.has("ct") : !patient.ct.empty())
  {
    if (fields.has("body"))
      fields.reject("body", "conflicts with ct; keep one of the two");
    fields.text("ct", patient.ct);
    if (fields.reading() || patient.patient_from_ct)
      visitRegistration(fields, patient);
    return;
  }
  fields.boolean("body", patient.body);
  if (fields.reading() && !patient.body)
    fields.reject("body", "neither body nor ct is given; set body: true, ct: FILE.vol, or remove patient");
}

}  // namespace

void visitFluoroscopy(yaml::Fields& fields, FluoroscopyScene& fluoroscopy)
{
  fields.number("rate", fluoroscopy.rate, quantities::kFrameRate, {0.0, 60.0, true, false});
  fields.integer("pixels", fluoroscopy.pixels, 16, 4096);
  visitAngulation(fields, fluoroscopy);
  fields.number("source_to_detector", fluoroscopy.source_to_detector, quantities::kSourceToDetector, Range::positive());
  fields.number("source_to_patient", fluoroscopy.source_to_patient, quantities::kSourceToPatient, Range::positive());
  if (fields.reading() && fluoroscopy.source_to_patient >= fluoroscopy.source_to_detector)
    fields.reject("source_to_patient", "the patient lies behind the detector; must be less than source_to_detector");
  fields.number("detector_width", fluoroscopy.detector_width, quantities::kDetectorWidth, Range::positive());
  visitGantry(fields, fluoroscopy);
  if (fields.reading() ? fields.has("isocentre") : fluoroscopy.isocentre.has_value())
  {
    if (!fluoroscopy.isocentre)
      fluoroscopy.isocentre = Eigen::Vector3d::Zero();
    fields.vector3("isocentre", *fluoroscopy.isocentre, quantities::kPosition);
  }
  fields.number("tube_voltage", fluoroscopy.tube_voltage, quantities::kTubeVoltage, Range::between(50.0, 125.0));
  fields.number("aluminium", fluoroscopy.aluminium, quantities::kFilter, Range::between(0.0, 0.02));
  fields.number("copper", fluoroscopy.copper, quantities::kFilter, Range::between(0.0, 2e-3));
  if (fields.reading() ? fields.has("energy") : fluoroscopy.energy.has_value())
  {
    if (!fluoroscopy.energy)
      fluoroscopy.energy = 60.0;
    fields.number("energy", *fluoroscopy.energy, quantities::kPhotonEnergy, Range::between(30.0, 100.0));
  }
  fields.number("detector_dose", fluoroscopy.detector_dose, quantities::kDetectorDose, Range::positive());
  fields.number("max_air_kerma_rate", fluoroscopy.max_air_kerma_rate, quantities::kDoseRate, Range::positive());
  fields.number("edge_enhancement", fluoroscopy.edge_enhancement, quantities::kRatio, Range::between(0.0, 4.0));
  fields.number("zoom", fluoroscopy.zoom, quantities::kRatio, Range::between(1.0, 8.0));
  fields.boolean("inverted", fluoroscopy.inverted);
  fields.number("recursive_filter", fluoroscopy.recursive_filter, quantities::kRatio, Range::between(0.0, 0.95));
  fields.number("iodine", fluoroscopy.iodine, quantities::kIodine, Range::between(0.0, 500.0));
  if (fields.reading() ? fields.has("patient") : fluoroscopy.patient.has_value())
  {
    if (!fluoroscopy.patient)
      fluoroscopy.patient.emplace();
    fields.map("patient", [&fluoroscopy](yaml::Fields& patient) { visitPatient(patient, *fluoroscopy.patient); });
    if (fields.reading() && fields.has("tissue_thickness"))
      fields.reject("tissue_thickness", "conflicts with patient; keep one of the two");
  }
  else
    fields.number("tissue_thickness", fluoroscopy.tissue_thickness, quantities::kTissue, Range::nonNegative());
  fields.boolean("follow_tip", fluoroscopy.follow_tip);
}

void checkPatient(const yaml::Fields& fields, const Scene& scene)
{
  if (scene.fluoroscopy && scene.fluoroscopy->patient && scene.fluoroscopy->patient->body && !scene.vessel)
    fields.reject("fluoroscopy.patient.body",
                  "is placed about a vessel, and the scene has none; add vessel, or remove "
                  "patient");
}

}  // namespace endovascular_sim::scene
