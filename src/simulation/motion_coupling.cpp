#include "simulation/motion_coupling.h"

#include "common/archive.h"
#include "common/archive_checks.h"
#include "common/error.h"
#include "common/text/format.h"
#include "common/text/words.h"

namespace endovascular_sim::simulation
{
namespace
{

constexpr double kEntryMargin = 0.01;  // from the fade to the introducer and its guide [m]

/** Refuses an introducer within the fade, or near it: its mouth and its guide rest.
 *  @throws InputError with the key of the entry */
void requireRestingEntry(const scene::Scene& scene, const motion::Fade& fade, const scene::EntryPose& entry)
{
  const double reach = fade.reach + kEntryMargin;
  const Eigen::Vector3d end = entry.position - scene.solver.guide_length * entry.direction;
  for (const Eigen::Vector3d& point : {entry.position, end})
    if ((point - fade.centre).norm() < reach)
      throw InputError(scene.file, "entry",
                       "the introducer is " + inMillimetres((point - fade.centre).norm()) + " from " +
                           inMillimetres(fade.centre) + ", around which the patient moves up to " +
                           inMillimetres(fade.reach) + "; give an entry at least " + inMillimetres(reach) +
                           " away, or remove motion");
}

}  // namespace

PatientMotion makePatientMotion(const scene::Scene& scene, const vessel::Vessel& vessel, const scene::EntryPose& entry)
{
  motion::MotionSettings settings = scene.motion->patient;
  settings.heart.rate = scene.motion->heart_rate;  // from the first beat on
  settings.breathing.rate = scene.motion->breathing_rate;
  motion::MovingPatient patient =
      motion::makeMovingPatient(vessel.centreline, settings, scene.solver.time_step, {scene.file, "motion.patient."});
  patient.holdBreath(scene.motion->breath_held);
  requireRestingEntry(scene, patient.map().frame().fade, entry);
  const motion::MapBounds bounds = motion::motionBounds(patient.motion(), motion::lumenPoints(vessel.centreline));
  return {std::move(patient), bounds};
}

void MotionCoupling::archive(Archive& archive)
{
  archive(patient_);
  if (!archive.reading())
    return;
  const double heart = patient_.heart().rate(), breath = patient_.breath().rate();
  requireLoaded(motion::refusalOf({heart, breath, false}).empty() && motion::refusalOf(patient_.controls()).empty(),
                "holds an impossible heart rate or breathing rate");
}

}  // namespace endovascular_sim::simulation
