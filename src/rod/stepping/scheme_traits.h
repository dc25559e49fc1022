#pragma once

#include <string>
#include <vector>

namespace endovascular_sim::rod
{

/** Capabilities of a time integration scheme. */
struct SchemeTraits
{
  std::string name;
  bool balloons = false;            ///< radii of contact that change, for balloons
  bool stack = false;               ///< several instruments, one inside the other
  bool moves_distal_end = false;    ///< motion of a held distal end, and its twist held
  bool holds_inserted_end = false;  ///< a held distal end behind an introducer
  bool clamped_tip_torque = false;  ///< external torque at a clamped tip
  bool adaptive = false;            ///< nodes that change, see Stepper::resample()
  bool saves = false;               ///< saved states, see Stepper::archive()
  bool observes = false;            ///< e.g. energy audits, see Stepper::setObserver()
  bool streams = false;             ///< nodes in a stream, see StepInput::drags
  bool moving_walls = false;        ///< walls that move by a map of space, see StepInput::wall
};

/** All schemes. The first one is the default, and has all capabilities. */
const std::vector<SchemeTraits>& schemes();

/** Traits of a scheme.
 *  @throws std::invalid_argument for an unknown name */
const SchemeTraits& schemeTraits(const std::string& name);

}  // namespace endovascular_sim::rod
