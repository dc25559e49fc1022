#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <string>

namespace endovascular_sim::nodes
{

/** Watch of a hand's grip on an instrument. It warns when the fingers slip, a chuck stands at its force limit, or the
 *  instrument waits at a stop, for a second of simulated time: the commands then have no effect. */
class GripWatch
{
public:
  static constexpr double kPatience = 1.0;  ///< duration of a slip before the warning, and of its end [s]

  /** Adds a step.
   *  @param slipped total slip of insertion and rotation: position that the commands have reached minus that of the
   *         instrument [m], [rad]
   *  @param load force and torque relative to their limits [1]
   *  @param dt duration of the step [s]
   *  @param waits true if a stop holds the insertion back (drive::HandControl::isStopped()) */
  void addStep(const std::array<double, 2>& slipped, const std::array<double, 2>& load, double dt, bool waits = false)
  {
    std::string warning;
    for (std::size_t axis = 0; axis < 2; ++axis)
    {
      const bool slips = has_last_ && std::abs(slipped[axis] - last_[axis]) > kLeastSlip[axis] * dt;
      Axis& watched = axes_[axis];
      const bool is_held = slips || std::abs(load[axis]) > kLimit || (axis == 0 && waits);
      watched.since_slip = is_held ? 0.0 : watched.since_slip + dt;
      watched.duration = watched.since_slip < kGap ? watched.duration + dt : 0.0;
      watched.is_warned = watched.duration >= kPatience || (watched.is_warned && watched.since_slip < kPatience);
      if (watched.is_warned && warning.empty())
        warning = axis == 0 && waits ? kWaits : kWarnings[axis];
    }
    last_ = slipped;
    has_last_ = true;
    changes_ += warning != warning_;
    warning_ = warning;
  }

  const std::string& warning() const { return warning_; }  ///< empty without one
  std::uint64_t changes() const { return changes_; }       ///< number of changes of the warning

private:
  struct Axis
  {
    double since_slip = 1e9;  ///< time since the last step that slipped [s]
    double duration = 0.0;    ///< of the slip, with short gaps [s]
    bool is_warned = false;
  };

  static constexpr std::array<double, 2> kLeastSlip = {1e-4, 0.01};  ///< speed of a slip [m/s], [rad/s]
  static constexpr double kLimit = 0.99;                             ///< load that counts as the limit [1]
  static constexpr double kGap = 0.2;                                ///< longest gap within a slip [s]
  static constexpr std::array<const char*, 2> kWarnings = {
      "the grip slips in the insertion: the instrument is held with drive.force_limit, jammed or at a stop; pull back",
      "the grip slips in the rotation: the instrument is held with drive.torque_limit; turn back"};

  static constexpr auto kWaits =
      "waits at a stop: the introducer, an end of the instrument or of its range, or another instrument in its way";

  std::array<Axis, 2> axes_;
  std::array<double, 2> last_{};
  bool has_last_ = false;
  std::string warning_;
  std::uint64_t changes_ = 0;
};

}  // namespace endovascular_sim::nodes
