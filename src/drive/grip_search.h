#pragma once

#include <cstddef>
#include <optional>
#include <utility>
#include <vector>

namespace endovascular_sim::drive
{

/** A hand in a step. */
struct GrippingHand
{
  double limit = 0.0;   ///< force at which the grip slips [N]
  double least = 0.0;   ///< stops of the instrument [m]
  double most = 0.0;    ///< [m]
  double before = 0.0;  ///< position before the step [m]
  double force = 0.0;   ///< force before the step, positive where the instrument resists pushing [N]
};

/** Search for the positions at the end of a step at which no hand bears more than its grip. A hand slips back to the
 *  position at which it bears its limit, or ahead where it is pulled.
 *
 *  The step is repeated at the positions of improve(). Of several hands beyond their limits, the one furthest beyond
 *  slips. Its position is found by false position (Illinois) on the reciprocal of the force: beyond the limit the force
 *  may have a pole, as that of a wire which friction locks in its bore. */
class GripSearch
{
public:
  explicit GripSearch(std::vector<GrippingHand> hands) : hands_(std::move(hands)) {}

  /** Takes the forces of a trial over, and sets the positions of the next trial.
   *  @param force of every hand in the trial [N]
   *  @param position of every hand in the trial, then in the next one [m]
   *  @return false: the trial is the result */
  bool improve(const std::vector<double>& force, std::vector<double>& position);

  /** True where no hand bears more than its grip, but for the tolerance. */
  static bool isWithin(double force, double limit);

private:
  /** Trial of the slipping hand. */
  struct Trial
  {
    bool known = false;
    double position = 0.0;  ///< [m]
    double excess = 0.0;    ///< 0 at the limit, positive beyond, see excessOf()
  };

  bool choose(const std::vector<double>& force, const std::vector<double>& position);
  void begin(double force, double position);
  double next(double force, double position);
  bool end(std::vector<double>& position);

  std::vector<GrippingHand> hands_;
  std::vector<double> wanted_;  ///< positions of the first trial [m]
  std::vector<double> best_;    ///< positions of the trial with the least excess [m]
  double least_ = 0.0;          ///< largest ratio of force and limit in that trial
  int trials_ = 0;
  std::optional<std::size_t> slipping_;  ///< hand that slips
  double sign_ = 1.0;                    ///< of its force
  Trial outside_, inside_;               ///< nearest trials beyond and within its limit
  bool is_assumed_ = false;              ///< inside_ is the position before the step
  bool was_outside_ = true;              ///< the last trial
  int same_side_ = 0;                    ///< trials on the same side of the limit before it
  double stride_ = 0.0;                  ///< of the search while no trial is within [m]
};

}  // namespace endovascular_sim::drive
