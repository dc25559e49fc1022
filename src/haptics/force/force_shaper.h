#pragma once

#include <cstdint>

#include "haptics/force/force_filter.h"
#include "haptics/force/force_output.h"
#include "haptics/force/motion_reference.h"
#include "haptics/force/passivity_channel.h"

namespace endovascular_sim::haptics
{

/** Settings of the force shaper. */
struct ShaperSettings
{
  bool passivity = true;
  PassivitySettings insertion;
  PassivitySettings rotation{5e-3, 2e-5, 5e-4, 0.02, 2e-3};
  double cutoff = 0.0;  ///< cutoff frequency of the low-pass filter [Hz]; 0: filter off
};

/** Force shaping between simulation and ForceOutput: a low-pass filter, then one passivity controller per direction.
 *  ForceOutput runs after it and enforces the limits. */
class ForceShaper
{
public:
  explicit ForceShaper(const ShaperSettings& settings = {});

  /** Adds a sample of the motion.
   *  @param device_time time on the device's clock, which wraps [µs]
   *  @param now arrival time [s] */
  void sample(const HandMotion& motion, std::uint32_t device_time, double now);
  /** @return shaped force, the input of ForceOutput */
  HandForce shape(const HandForce& wanted, double now);
  /** Records the force that was sent to the device at time @p now [s]. */
  void rendered(const HandForce& force, double now);
  /** Discards the history of motion and force, after the user released the handle or the link was lost. */
  void reset();

  const PassivityReport& insertion() const { return insertion_.report(); }
  const PassivityReport& rotation() const { return rotation_.report(); }

private:
  ShaperSettings settings_;
  ForceFilter filter_;
  PassivityChannel insertion_;
  PassivityChannel rotation_;
  std::uint32_t device_time_ = 0;
  double arrival_ = 0.0;
};

}  // namespace endovascular_sim::haptics
