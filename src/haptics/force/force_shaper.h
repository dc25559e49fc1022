#pragma once

#include <cstdint>

#include "haptics/force/force_filter.h"
#include "haptics/force/force_output.h"
#include "haptics/force/motion_reference.h"
#include "haptics/force/passivity_channel.h"

namespace endovascular_sim::haptics
{

/** What is done to a force before it is limited. */
struct ShaperSettings
{
  bool passivity = true;
  PassivitySettings insertion;
  PassivitySettings rotation{5e-3, 2e-5, 5e-4, 0.02, 2e-3};
  double cutoff = 0.0;  ///< of the low pass [Hz]; 0: none
};

/** From the simulation's force to the one that ForceOutput limits: low pass, then passivity controller per direction.
 *  ForceOutput comes last, so nothing here can exceed the limits. */
class ForceShaper
{
public:
  explicit ForceShaper(const ShaperSettings& settings = {});

  /** A sample of the motion. @param device_time [µs], wraps @param now its arrival [s] */
  void sample(const HandMotion& motion, std::uint32_t device_time, double now);
  /** @return the force to ask of ForceOutput */
  HandForce shape(const HandForce& wanted, double now);
  /** What was sent to the device at @p now. */
  void rendered(const HandForce& force, double now);
  /** The hand has let go, or the link: what comes is no continuation. */
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
