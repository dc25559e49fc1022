#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <vector>

#include "fluoroscopy/angiography/pulse_train.h"
#include "fluoroscopy/motion/body_motion.h"
#include "simulation/fluoroscopy_system.h"
#include "simulation/imaged_bodies.h"

namespace endovascular_sim::nodes
{

/** What is imaged by a pulse: instruments, patient and contrast medium after a step. */
struct ImagedState
{
  std::uint64_t steps = 0;  ///< number of steps before it
  std::uint64_t pulse = 0;  ///< newest pulse at or before them
  std::uint64_t stamp = 0;  ///< of the message of the instruments [ns]; 0: unknown
  simulation::ImagedInstruments instruments;
  std::optional<simulation::ImagedTreatment> treatment;
  std::optional<fluoroscopy::BodyMotion> motion;
  std::optional<simulation::ContrastMedium> contrast;
};

/** States of the simulation at pulses, put together from messages of the same step, which arrive in any order.
 *
 *  A state of a running simulation is complete when all of its parts have arrived. Before the first state that lies at
 * a pulse, and in a recording, which holds others only, any first state after a pulse stands for it, with the last
 * parts that are known. A step back forgets all states. */
class PulseStates
{
public:
  static constexpr std::size_t kMost = 128;  ///< states that wait; the oldest ones are forgotten

  /** Parts of every state beside the instruments. */
  struct Parts
  {
    bool motion = false, treatment = false, contrast = false;
  };
  /** @param recorded true: the states are those of a recording */
  PulseStates(const fluoroscopy::PulseTrain& pulses, Parts parts, bool recorded)
    : pulses_(pulses), parts_(parts), recorded_(recorded)
  {
  }

  /** True if a part of this step may be needed. @param steps number of steps */
  bool accepts(std::uint64_t steps) const { return !at_pulses_ || pulses_.isPulse(steps); }

  /** Adds a part of the state after a number of steps. @{ */
  void addInstruments(std::uint64_t steps, simulation::ImagedInstruments instruments, std::uint64_t stamp = 0);
  void addTreatment(std::uint64_t steps, simulation::ImagedTreatment treatment);
  void addMotion(std::uint64_t steps, const fluoroscopy::BodyMotion& motion);
  void addContrast(std::uint64_t steps, simulation::ContrastMedium contrast);
  /** @} */

  /** Takes a state of a pulse after the last one taken; nothing if there is none. Older states are left out.
   *  @param in_order true: the oldest one, so that none is left out; false: the newest one */
  std::optional<ImagedState> take(bool in_order);

  const fluoroscopy::PulseTrain& pulses() const { return pulses_; }

private:
  struct Waiting
  {
    std::optional<simulation::ImagedInstruments> instruments;
    std::optional<simulation::ImagedTreatment> treatment;
    std::optional<fluoroscopy::BodyMotion> motion;
    std::optional<simulation::ContrastMedium> contrast;
    std::uint64_t stamp = 0;
  };

  Waiting& at(std::uint64_t steps);
  bool isReady(std::uint64_t steps, const Waiting& state) const;

  fluoroscopy::PulseTrain pulses_;
  Parts parts_;
  bool recorded_;
  bool at_pulses_ = false;  ///< states at pulses arrive
  std::map<std::uint64_t, Waiting> states_;
  std::optional<std::uint64_t> taken_;  ///< newest pulse that was taken
  std::uint64_t newest_ = 0;            ///< number of steps of the newest instruments
  std::optional<simulation::ImagedTreatment> last_treatment_;
  std::optional<fluoroscopy::BodyMotion> last_motion_;
  std::optional<simulation::ContrastMedium> last_contrast_;
};

}  // namespace endovascular_sim::nodes
