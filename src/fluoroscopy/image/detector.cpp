#include "fluoroscopy/image/detector.h"

#include <algorithm>
#include <cmath>

namespace endovascular_sim::fluoroscopy
{
namespace
{

constexpr double kWhite = -0.5;          // compressed optical depth of grey value 255
constexpr double kBlack = 2.2;           // compressed optical depth of grey value 0
constexpr double kCompression = 1.2;     // optical depth scale w of the compression
constexpr double kMinIntensity = 1e-30;  // avoids an infinite logarithm

double opticalDepth(double intensity)
{
  return -std::log(std::max(intensity, kMinIntensity));
}

}  // namespace

std::uint16_t Detector::signal(double intensity)
{
  return static_cast<std::uint16_t>(std::lround(std::clamp(kBackgroundSignal * intensity, 0.0, 65535.0)));
}

std::uint8_t Detector::grey(double background, double wire)
{
  const double depth = opticalDepth(background);
  const double compressed = depth > 0.0 ? kCompression * (1.0 - std::exp(-depth / kCompression)) : depth;
  const double level = (kBlack - compressed - opticalDepth(wire)) / (kBlack - kWhite);
  return static_cast<std::uint8_t>(std::lround(255.0 * std::clamp(level, 0.0, 1.0)));
}

}  // namespace endovascular_sim::fluoroscopy
