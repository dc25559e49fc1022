#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "fluoroscopy/projection/x_ray_geometry.h"

namespace endovascular_sim::fluoroscopy
{

/** Mask of digital subtraction angiography: mean of the first frames of a run, M = Σ I_k / n, at consecutive pulses. It
 *  belongs to the pose and the tube charge of its frames. */
class Mask
{
public:
  /** @param frames number n of its frames, at least 1 */
  explicit Mask(int frames) : wanted_(frames) {}

  /** Adds a frame. A frame in another pose than those before, or after a gap, begins the mask anew.
   *  @param counts of the detector
   *  @param tube_charge [mAs]
   *  @pre the mask is not complete */
  void add(std::uint64_t pulse, const std::vector<std::uint16_t>& counts, double tube_charge, const CArmPose& pose);

  bool isComplete() const { return taken_ == wanted_; }
  int taken() const { return taken_; }                     ///< frames so far
  int wanted() const { return wanted_; }                   ///< frames of the complete mask
  std::uint64_t lastPulse() const { return last_pulse_; }  ///< of the frames so far

  double tubeCharge() const { return tube_charge_; }  ///< of the frames, 0 without one [mAs]
  const CArmPose& pose() const { return pose_; }      ///< of the frames

  /** Natural logarithms of the mean counts, row-major. @pre the mask is complete */
  const std::vector<float>& logarithms() const { return values_; }

private:
  int wanted_, taken_ = 0;
  std::uint64_t last_pulse_ = 0;
  double tube_charge_ = 0.0;
  CArmPose pose_;
  std::vector<float> values_;  ///< sums of the counts, exact in 24 bits; finally the logarithms
};

/** Motion that separates two poses, for a message: "the table has moved"; empty for equal poses. */
std::string motionBetween(const CArmPose& before, const CArmPose& after);

}  // namespace endovascular_sim::fluoroscopy
