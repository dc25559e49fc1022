#include "simulation/motion_coupling.h"

#include <algorithm>
#include <cmath>

#include "common/archive.h"
#include "common/archive_checks.h"
#include "common/error.h"
#include "common/text/format.h"
#include "common/text/words.h"

namespace endovascular_sim::simulation
{
namespace
{

constexpr double kCatchUp = 0.5;  // share of the rate by which the speed of the heart differs from it at most
constexpr auto kTag = "motion";   // in saved states

double wrapped(double phase)
{
  return phase - std::floor(phase);
}

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

MotionCoupling::MotionCoupling(const PatientMotion& motion, double time_step, contact::ContactSource* contacts)
  : time_step_(time_step), patient_(motion.patient), wall_(contacts, motion.bounds)
{
}

void MotionCoupling::beginStep(const HeartClock* clock)
{
  const motion::MotionMap before = patient_.map();
  if (clock == nullptr)
    patient_.advance();
  else if (clock->rate == 0.0)
    patient_.advanceInArrest();
  else
  {
    const double own = patient_.heart().phase();
    const double step = clock->rate * time_step_;
    double ahead = wrapped(clock->phase - own);  // of this phase, to the nearer side
    if (ahead > 0.5)
      ahead -= 1.0;
    patient_.advanceWithHeart(wrapped(own + std::clamp(ahead, (1.0 - kCatchUp) * step, (1.0 + kCatchUp) * step)),
                              clock->rate);
  }
  wall_.beginStep(before, patient_.map());
}

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
  std::string tag = kTag;
  archive(tag);
  requireLoaded(tag == kTag, "holds no motion of the patient");
  archive(patient_);
  if (!archive.reading())
    return;
  const double heart = patient_.heart().rate(), breath = patient_.breath().rate();
  requireLoaded(motion::refusalOf({heart, breath, false}).empty() && motion::refusalOf(patient_.controls()).empty(),
                "holds an impossible heart rate or breathing rate");
}

}  // namespace endovascular_sim::simulation
