#include "phantom/tissue.h"

#include <algorithm>

#include "fluoroscopy/patient/volume/hounsfield.h"

namespace endovascular_sim::phantom
{
namespace
{

// Signal of the lumen in the abdominal MR angiogram: 2,300 at the heart, 860 in the groins.
constexpr double kMostSignal = 2300.0;
constexpr double kLeastSignal = 860.0;
constexpr double kHighest = 0.30;  // m
constexpr double kLowest = -0.22;  // m

double hounsfield(Tissue tissue)
{
  switch (tissue)
  {
    case Tissue::kAir:
      return -1000.0;
    case Tissue::kLung:
      return -850.0;
    case Tissue::kFat:
      return -90.0;
    case Tissue::kSoftTissue:
      return 55.0;
    case Tissue::kMyocardium:
      return 110.0;
    case Tissue::kLeftVentricle:
      return 380.0;
    case Tissue::kRightVentricle:
      return 210.0;
    case Tissue::kLeftAtrium:
      return 360.0;
    case Tissue::kPulmonaryTrunk:
      return 300.0;
    case Tissue::kVein:
      return 220.0;
    case Tissue::kCortex:
      return 700.0;
    case Tissue::kWall:
      return 60.0;
    case Tissue::kLumen:
      return 400.0;
    case Tissue::kCalcium:
      return 1100.0;
  }
  return 0.0;
}

double magneticSignal(Tissue tissue, double height)
{
  const double lumen =
      kLeastSignal + (kMostSignal - kLeastSignal) * std::clamp((height - kLowest) / (kHighest - kLowest), 0.0, 1.0);
  switch (tissue)
  {
    case Tissue::kLumen:
      return lumen;
    case Tissue::kLeftVentricle:
    case Tissue::kLeftAtrium:
      return 0.95 * lumen;
    case Tissue::kRightVentricle:
    case Tissue::kPulmonaryTrunk:
    case Tissue::kVein:
      return 0.45 * lumen;
    case Tissue::kFat:
      return 330.0;
    case Tissue::kAir:
      return 20.0;
    case Tissue::kLung:
    case Tissue::kCortex:
    case Tissue::kCalcium:
      return 50.0;
    default:
      return 240.0;
  }
}

/** Tissue of a density, for the signal of magnetic resonance. */
Tissue tissueOf(const fluoroscopy::Density& density)
{
  if (density.bone > 300.0)
    return Tissue::kCortex;
  const double total = density.tissue + density.bone;
  return total < 130.0   ? Tissue::kAir
         : total < 600.0 ? Tissue::kLung
         : total < 990.0 ? Tissue::kFat
                         : Tissue::kSoftTissue;
}

}  // namespace

double tissueValue(Tissue tissue, image::Modality modality, double height)
{
  return modality == image::Modality::kCt ? hounsfield(tissue) : magneticSignal(tissue, height);
}

double bodyValue(const fluoroscopy::Density& density, image::Modality modality, double height)
{
  return modality == image::Modality::kCt ? fluoroscopy::hounsfieldOf(density)
                                          : magneticSignal(tissueOf(density), height);
}

}  // namespace endovascular_sim::phantom
