#pragma once

#include <Eigen/Core>

#include "motion/body/motion_settings.h"
#include "motion/cycle/time_course.h"
#include "motion/map/motion_map.h"

namespace endovascular_sim::motion
{

/** Motions as shares of their amplitudes [1]; the same numbers describe their derivatives by the time [1/s]. */
struct MotionShares
{
  double longitudinal = 0.0;  ///< displacement of the heart's base
  double radial = 0.0;        ///< shortening across the axis
  double twist = 0.0;         ///< rotations of base and apex
  double breath = 0.0;        ///< inspiration
};

/** Motion of a patient as a function of the phases of heartbeat and breath. */
class PatientMotion
{
public:
  PatientMotion(const HeartFrame& frame, const MotionSettings& settings);

  /** Shares and their derivatives by the time at an instant. */
  struct Instant
  {
    MotionShares shares, rates;
  };
  /** @param heart_phase in [0, 1), 0 at end-diastole
   *  @param heart_rate of the beat [Hz]
   *  @param breath_phase in [0, 1), 0 at end-expiration
   *  @param breath_speed of the phase [1/s]; 0 while the breath is held */
  Instant at(double heart_phase, double heart_rate, double breath_phase, double breath_speed) const;

  MotionMap map(const Instant& instant) const;

  const HeartFrame& frame() const { return frame_; }
  const MotionSettings& settings() const { return settings_; }

private:
  MotionField heartField(const MotionShares& shares) const;
  /** Adds the rigid motion of a share of a breath, and its derivative times a rate of that share. */
  void addBreath(double share, double rate, MotionField& field, MotionField& field_rate) const;

  HeartFrame frame_;
  MotionSettings settings_;
  TimeCourse longitudinal_, radial_, twist_, breath_;
};

}  // namespace endovascular_sim::motion
