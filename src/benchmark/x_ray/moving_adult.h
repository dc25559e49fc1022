#pragma once

#include <cmath>

#include "fluoroscopy/motion/body_motion.h"
#include "motion/moving_patient.h"
#include "scene/file_search.h"
#include "vessel/model/vessel.h"

namespace endovascular_sim::benchmark
{

// Rates that no multiple of the frame rate repeats, as those of a person: 71 beats and 14.8 breaths per minute at 15/s.
constexpr double kBeatsPerFrame = 0.0789;
constexpr double kBreathsPerFrame = 0.01643;

/** Motion of an adult with the heart of the default anatomy. */
class MovingAdult
{
public:
  explicit MovingAdult(const vessel::Vessel& vessel)
    : settings_(motion::readMotion(scene::configFolder() + "/motion/adult.yaml")),
      motion_(motion::placeHeart(vessel.centreline, settings_.region, {"benchmark", "motion."}), settings_)
  {
  }

  fluoroscopy::BodyMotion at(double heart_phase, double breath_phase) const
  {
    const motion::PatientMotion::Instant instant =
        motion_.at(heart_phase, settings_.heart.rate, breath_phase, settings_.breathing.rate);
    return {motion_.map(instant), instant.shares.breath * settings_.breathing.diaphragm};
  }

  fluoroscopy::BodyMotion ofFrame(int frame) const
  {
    return at(std::fmod(frame * kBeatsPerFrame, 1.0), std::fmod(frame * kBreathsPerFrame, 1.0));
  }

  double systole() const { return settings_.heart.systolicShare(settings_.heart.rate); }
  double inspiration() const { return settings_.breathing.inspiration; }
  const motion::HeartFrame& heart() const { return motion_.frame(); }
  const motion::PatientMotion& motion() const { return motion_; }

private:
  motion::MotionSettings settings_;
  motion::PatientMotion motion_;
};

}  // namespace endovascular_sim::benchmark
