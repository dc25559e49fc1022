#include "fluoroscopy/detector.h"

#include <algorithm>
#include <cmath>

namespace endovascular_sim::fluoroscopy
{
namespace
{

constexpr double kWindowLow = -0.1;   // optical depth shown white
constexpr double kWindowHigh = 5.0;   // optical depth shown black
constexpr double kWindowScale = 1.5;  // optical depth over which the curve bends

}  // namespace

std::uint16_t Detector::signal(double intensity)
{
  return static_cast<std::uint16_t>(std::clamp(kBackgroundSignal * intensity + 0.5, 0.0, 65535.0));
}

std::uint8_t Detector::grey(double intensity)
{
  static const double kRange = std::log1p((kWindowHigh - kWindowLow) / kWindowScale);
  const double depth = std::clamp(-std::log(std::max(intensity, 1e-30)), kWindowLow, kWindowHigh);
  const double level = std::log1p((depth - kWindowLow) / kWindowScale) / kRange;
  return static_cast<std::uint8_t>(255.0 * (1.0 - level) + 0.5);
}

}  // namespace endovascular_sim::fluoroscopy
