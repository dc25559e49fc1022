#include "scene/model/scene_contrast.h"

#include <cmath>

#include "contrast/medium/medium_viscosity.h"

namespace endovascular_sim::scene
{

const contrast::Syringe& ContrastScene::syringe() const
{
  return kind == SyringeKind::kHand ? contrast::kHandSyringe : contrast::kPumpSyringe;
}

contrast::Injection ContrastScene::injection(double volume, double rate, double rise, double iodine) const
{
  if (std::isnan(iodine))
    return {volume, rate, rise, concentration, viscosity};
  return {volume, rate, rise, iodine, contrast::mediumViscosity(iodine)};
}

}  // namespace endovascular_sim::scene
