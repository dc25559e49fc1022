#pragma once

#include <memory>

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
 *  @throws InputError with key and remedy, see motion::makeMovingPatient(); and if the introducer lies where the patient
 *          moves */
PatientMotion makePatientMotion(const scene::Scene& scene, const vessel::Vessel& vessel, const scene::EntryPose& entry);

/** Motion of the patient in a simulation: it advances with every step, and the wall with it. */
class MotionCoupling
{
public:
  explicit MotionCoupling(const PatientMotion& motion) : patient_(motion.patient), bounds_(motion.bounds) {}

  /** Rates and breath-hold; a rate acts from the next beat or breath on.
   *  @throws std::invalid_argument for values that motion::refusalOf() refuses @{ */
  void setControls(const motion::MotionControls& controls) { patient_.setControls(controls); }
  motion::MotionControls controls() const { return patient_.controls(); }
  /** @} */

  /** Patient after the last step: phases, and the map from the resting patient to the moved one. */
  const motion::MovingPatient& patient() const { return patient_; }

  /** Advances by a step. */
  void advance() { patient_.advance(); }

  void archive(Archive& archive);

private:
  motion::MovingPatient patient_;
  motion::MapBounds bounds_;
};

}  // namespace endovascular_sim::simulation
