#pragma once

#include <memory>

#include "motion/contact/moving_wall.h"
#include "motion/moving_patient.h"
#include "scene/model/scene.h"
#include "scene/scene_vessel.h"
#include "vessel/model/vessel.h"

namespace endovascular_sim
{
class Archive;
}

namespace endovascular_sim::simulation
{

/** Motion of a scene's patient, prepared for its vessel. */
struct PatientMotion
{
  motion::MovingPatient patient;  ///< at rest
  motion::MapBounds bounds;       ///< at the points of the lumen, over a beat and a breath
};

/** Places the motion of a scene in its vessel and checks it.
 *  @param scene with the key `motion`
 *  @throws InputError with key and remedy, see motion::makeMovingPatient(); and if the introducer lies where the
 * patient moves */
PatientMotion makePatientMotion(const scene::Scene& scene, const vessel::Vessel& vessel, const scene::EntryPose& entry);

/** Clock of a heart outside of the motion, e.g. that of the flow of blood. */
struct HeartClock
{
  double phase = 0.0;  ///< at the end of the coming step, 0 at end-diastole [1]
  double rate = 0.0;   ///< [Hz]; 0: arrest
};

/** Motion of the patient in a simulation: it advances with every step, and the wall with it. */
class MotionCoupling
{
public:
  /** @param time_step of the simulation [s]
   *  @param contacts of the vessel at rest; null without a vessel. Must outlive this */
  MotionCoupling(const PatientMotion& motion, double time_step, contact::ContactSource* contacts);

  /** Contact sets of the moving vessel. */
  contact::ContactSource* contacts() { return &wall_; }

  /** Advances the patient by a step, in which the wall then moves.
   *  @param clock that the heart follows: its speed differs from the rate by at most a half while it catches up; null:
   *         its own */
  void beginStep(const HeartClock* clock);

  /** Motion of the wall in the present step; null if nothing moves. */
  contact::WallMotion* wall() { return wall_.moves() ? &wall_ : nullptr; }

  /** Rates and breath-hold; a rate acts from the next beat or breath on.
   *  @throws std::invalid_argument for values that motion::refusalOf() refuses @{ */
  void setControls(const motion::MotionControls& controls) { patient_.setControls(controls); }
  motion::MotionControls controls() const { return patient_.controls(); }
  /** @} */

  /** Patient after the last step: phases, and the map from the resting patient to the moved one. */
  const motion::MovingPatient& patient() const { return patient_; }

  void archive(Archive& archive);

private:
  double time_step_;
  motion::MovingPatient patient_;
  motion::MovingWall wall_;
};

}  // namespace endovascular_sim::simulation
