#pragma once

#include <array>
#include <string>

#include "rviz_plugin/model/velocity_commander.h"

namespace endovascular_sim::rviz_plugin
{

/** Motion that a button or a key holds. */
enum class Motion
{
  kPush,
  kPull,
  kTwistLeft,   ///< negative rotation: in AP, a tip that points to the viewer turns to the left
  kTwistRight,  ///< positive rotation
};
constexpr std::size_t kMotions = 4;

/** Velocity from the motions that are held, a speed setting and the chosen instrument. Buttons and keys add up: a
 * motion ends when both are released. A stick adds a share of the speed. */
class OperatorControls
{
public:
  enum class Source
  {
    kButton,
    kKey,
  };

  void press(Motion motion, Source source) { held(source)[static_cast<std::size_t>(motion)] = true; }
  void release(Motion motion, Source source) { held(source)[static_cast<std::size_t>(motion)] = false; }
  /** Position of a stick, from −1 to 1: a share of the speed.
   *  @param push, twist other values count as 0 */
  void setStick(double push, double twist);
  void releaseAll();

  /** Chooses an instrument; all motions end.
   *  @param largest_speed, largest_turning_speed of the instrument [m/s], [rad/s] */
  void choose(const std::string& instrument, double largest_speed, double largest_turning_speed);
  const std::string& instrument() const { return instrument_; }

  /** Sets the speed.
   *  @param setting 0 to 1, from the slowest to the fastest speed on a logarithmic scale */
  void setSpeed(double setting);
  double speed() const;         ///< of a push [m/s]
  double turningSpeed() const;  ///< of a twist [rad/s]

  HandVelocity velocity() const;

private:
  using Held = std::array<bool, kMotions>;
  Held& held(Source source) { return source == Source::kButton ? by_button_ : by_key_; }
  bool isHeld(Motion motion) const;

  Held by_button_{}, by_key_{};
  double stick_push_ = 0.0, stick_twist_ = 0.0;  ///< from −1 to 1
  std::string instrument_;
  double largest_speed_ = 0.0, largest_turning_speed_ = 0.0;
  double setting_ = 0.5;
};

}  // namespace endovascular_sim::rviz_plugin
