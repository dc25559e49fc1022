#include "rviz_plugin/model/operator_controls.h"

#include <algorithm>
#include <cmath>

namespace endovascular_sim::rviz_plugin
{
namespace
{

// Speeds of hands: from a fine adjustment to a fast advance.
constexpr double kSlowest = 1e-3, kFastest = 0.1;                // [m/s]
constexpr double kSlowestTurn = 0.1, kFastestTurn = 2.0 * M_PI;  // [rad/s]

double onLogarithmicScale(double setting, double low, double high)
{
  return low * std::pow(high / low, setting);
}

}  // namespace

void OperatorControls::releaseAll()
{
  by_button_.fill(false);
  by_key_.fill(false);
  stick_push_ = stick_twist_ = 0.0;
}

void OperatorControls::setStick(double push, double twist)
{
  stick_push_ = std::isfinite(push) ? std::clamp(push, -1.0, 1.0) : 0.0;
  stick_twist_ = std::isfinite(twist) ? std::clamp(twist, -1.0, 1.0) : 0.0;
}

void OperatorControls::choose(const std::string& instrument, double largest_speed, double largest_turning_speed)
{
  releaseAll();
  instrument_ = instrument;
  largest_speed_ = largest_speed;
  largest_turning_speed_ = largest_turning_speed;
}

void OperatorControls::setSpeed(double setting)
{
  setting_ = std::isfinite(setting) ? std::clamp(setting, 0.0, 1.0) : 0.0;
}

double OperatorControls::speed() const
{
  return std::min(onLogarithmicScale(setting_, kSlowest, kFastest), largest_speed_);
}

double OperatorControls::turningSpeed() const
{
  return std::min(onLogarithmicScale(setting_, kSlowestTurn, kFastestTurn), largest_turning_speed_);
}

bool OperatorControls::isHeld(Motion motion) const
{
  const auto index = static_cast<std::size_t>(motion);
  return by_button_[index] || by_key_[index];
}

HandVelocity OperatorControls::velocity() const
{
  if (instrument_.empty())
    return {};
  const double push = (isHeld(Motion::kPush) ? 1 : 0) - (isHeld(Motion::kPull) ? 1 : 0);
  const double twist = (isHeld(Motion::kTwistRight) ? 1 : 0) - (isHeld(Motion::kTwistLeft) ? 1 : 0);
  return {instrument_, std::clamp(push + stick_push_, -1.0, 1.0) * speed(),
          std::clamp(twist + stick_twist_, -1.0, 1.0) * turningSpeed()};
}

}  // namespace endovascular_sim::rviz_plugin
