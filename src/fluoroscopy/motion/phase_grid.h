#pragma once

#include <cstddef>
#include <vector>

#include <Eigen/Core>

#include "fluoroscopy/motion/body_motion.h"
#include "motion/body/patient_motion.h"

namespace endovascular_sim::fluoroscopy
{

/** Fixed grid of motions of a patient: phases of the heart × shares of a breath. The nearest of them stands for any
 *  motion, so that few projections of the moved tissue are needed, and an image does not depend on those before it.
 *
 *  Two motions differ by the largest distance between the places of a point of the patient: of the diaphragm, and of
 *  15 points in and around the heart. Every motion of the patient is within the tolerance of a motion of the grid. The
 * first motion of the grid is rest. */
class PhaseGrid
{
public:
  static constexpr double kTolerance = 0.7e-3;  ///< of the places [m]

  /** @param tolerance [m] */
  explicit PhaseGrid(const motion::PatientMotion& motion, double tolerance = kTolerance);

  /** Motion of the grid nearest to a motion of the same heart; the first one of equally near ones. A motion of another
   *  heart is returned unchanged. */
  BodyMotion nearest(const BodyMotion& motion) const;

  std::size_t size() const { return motions_.size(); }  ///< number of motions

private:
  std::vector<BodyMotion> motions_;
  std::vector<std::vector<Eigen::Vector3d>> places_;  ///< displacements of each motion [m]
};

/** Largest distance between the places of a point of the patient in two motions, by the points of PhaseGrid [m]. */
double distanceBetween(const BodyMotion& a, const BodyMotion& b);

}  // namespace endovascular_sim::fluoroscopy
