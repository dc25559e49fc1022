#include "phantom/tissue.h"

#include <algorithm>

#include "patient/volume/hounsfield.h"

namespace endovascular_sim::phantom
{
namespace
{

using patient::Tissue;

// Signal of the lumen in the abdominal MR angiogram: 2,300 at the heart, 860 in the groins.
constexpr double kMostSignal = 2300.0;
constexpr double kLeastSignal = 860.0;
constexpr double kHighest = 0.30;  // m
constexpr double kLowest = -0.22;  // m

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
    case Tissue::kRightAtrium:
    case Tissue::kPulmonaryTrunk:
    case Tissue::kCardiacVein:
      return 0.45 * lumen;
    case Tissue::kFat:
      return 330.0;
    case Tissue::kAir:
      return 20.0;
    case Tissue::kLung:
    case Tissue::kBone:
    case Tissue::kCalcium:
      return 50.0;
    default:
      return 240.0;
  }
}

/** Tissue of a density, for the signal of magnetic resonance. */
Tissue tissueOf(const patient::Density& density)
{
  if (density.bone > 300.0)
    return Tissue::kBone;
  const double total = density.tissue + density.bone;
  return total < 130.0 ? Tissue::kAir : total < 600.0 ? Tissue::kLung : total < 990.0 ? Tissue::kFat : Tissue::kMuscle;
}

}  // namespace

double tissueValue(Tissue tissue, image::Modality modality, double height)
{
  return modality == image::Modality::kCt ? patient::propertiesOf(tissue).hounsfield : magneticSignal(tissue, height);
}

double bodyValue(const patient::Density& density, image::Modality modality, double height)
{
  return modality == image::Modality::kCt ? patient::hounsfieldOf(density) : magneticSignal(tissueOf(density), height);
}

}  // namespace endovascular_sim::phantom
