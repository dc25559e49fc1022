#pragma once

#include <vector>

#include <Eigen/Core>

#include "motion/body/heart_placement.h"
#include "motion/body/patient_motion.h"
#include "motion/cycle/cycle.h"
#include "motion/map/map_bounds.h"
#include "motion/motion_controls.h"

namespace endovascular_sim
{
class Archive;
}

namespace endovascular_sim::motion
{

/** Patient whose heart beats and whose lungs breathe: phases, and the map of the present step. At the beginning the
 *  patient is at rest: end-diastole and end-expiration. */
class MovingPatient
{
public:
  /** @param time_step of advance() [s] */
  MovingPatient(const HeartFrame& frame, const MotionSettings& settings, double time_step);

  /** Advances both phases by a step. */
  void advance();

  /** Heart rate from the next beat on [Hz]. @throws std::invalid_argument outside of 20 to 300 beats per minute */
  void setHeartRate(double rate);
  /** Breathing rate from the next breath on [Hz]. @throws std::invalid_argument outside of 1.8 to 60 breaths per minute
   */
  void setBreathingRate(double rate);
  /** Holds the breath from the next end of an expiration on, or lets it go. */
  void holdBreath(bool held) { breath_.hold(held); }
  /** Rates from the next cycles on, and breath-hold.
   *  @throws std::invalid_argument for values that refusalOf() refuses @{ */
  void setControls(const MotionControls& controls);
  MotionControls controls() const { return {heart_.nextRate(), breath_.nextRate(), breath_.held()}; }
  /** @} */
  /** Advances by a step in which a clock outside leads the heart, such as that of the flow of blood.
   *  @param phase of the heart at the end of the step, in [0, 1)
   *  @param rate of the present beat [Hz]
   *  @throws std::invalid_argument for others */
  void advanceWithHeart(double phase, double rate);
  /** Advances by a step of an arrest: the heart stops at the end of its beat. */
  void advanceInArrest();

  /** Sets the heart by a clock outside, such as that of the flow of blood.
   *  @param phase in [0, 1), 0 at end-diastole
   *  @param rate of the present beat [Hz]
   *  @throws std::invalid_argument for others */
  void setHeartPhase(double phase, double rate);
  /** Sets phase and rate of the breath. @throws std::invalid_argument as setHeartPhase() */
  void setBreathPhase(double phase, double rate);

  /** Map of the present step. A copy keeps that of a step before. */
  const MotionMap& map() const { return map_; }
  const Cycle& heart() const { return heart_; }
  const Cycle& breath() const { return breath_; }
  const MotionShares& shares() const { return shares_; }
  /** True in systole, from end-diastole to end-systole. */
  bool systole() const { return heart_.phase() < motion_.settings().heart.systolicShare(heart_.rate()); }
  /** Displacement of the diaphragm towards the feet [m]. */
  double diaphragm() const { return shares_.breath * motion_.settings().breathing.diaphragm; }
  const PatientMotion& motion() const { return motion_; }

  void archive(Archive& archive);

private:
  void update();

  PatientMotion motion_;
  double time_step_;
  Cycle heart_, breath_;
  MotionShares shares_;
  MotionMap map_;
};

/** Bounds of a motion at points of the resting patient, over a beat at end-expiration and at end-inspiration. Speeds
 * are those at the rates of the settings. @param points [m] */
MapBounds motionBounds(const PatientMotion& motion, const std::vector<Eigen::Vector3d>& points);

/** Points on the centreline and near the wall of a vessel, where an instrument may be [m]. */
std::vector<Eigen::Vector3d> lumenPoints(const vessel::CentrelineTree& tree);

/** Places and checks a motion in a vessel.
 *  @throws InputError with key and remedy as placeHeart(), and if the motion folds space */
MovingPatient makeMovingPatient(const vessel::CentrelineTree& tree, const MotionSettings& settings, double time_step,
                                const MotionSource& source);

}  // namespace endovascular_sim::motion
