#pragma once

namespace endovascular_sim::segmentation
{

/** Hounsfield units of tissues. Contrast-filled blood of a CT angiogram lies between the least and the most contrast.
 *  @{ */
constexpr double kAir = -300.0;
constexpr double kFat = -20.0;
constexpr double kSoftTissue = 60.0;
constexpr double kLeastContrast = 150.0;
constexpr double kMostContrast = 800.0;
/** @} */

constexpr double kOnWall = 0.45;   ///< contrast, in that of the other clicks, below which a click lies on the wall
constexpr double kInLumen = 0.75;  ///< likewise, from which a place lies in the lumen

/** Name of the tissue of a value outside of the range of contrast-filled blood [HU]. */
constexpr const char* tissueName(double value)
{
  if (value < kAir)
    return "air or lung";
  if (value < kFat)
    return "fat";
  if (value < kLeastContrast)
    return "soft tissue or the wall";
  return "bone, calcium or metal";
}

}  // namespace endovascular_sim::segmentation
