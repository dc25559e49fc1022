#include "simulation/motion_coupling.h"

#include <algorithm>
#include <cmath>

#include "common/archive.h"
#include "common/archive_checks.h"

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

void MotionCoupling::archive(Archive& archive)
{
  std::string tag = kTag;
  archive(tag);
  requireLoaded(tag == kTag, "holds no motion of the patient");
  archive(patient_);
}

}  // namespace endovascular_sim::simulation
