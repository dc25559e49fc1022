#include "results/contrast_use.h"

#include <nlohmann/json.hpp>

namespace endovascular_sim::results
{

ContrastUse contrastUseOf(const simulation::Simulation& simulation)
{
  ContrastUse use;
  use.volume = simulation.contrast()->injectedVolume();
  use.missed = simulation.contrast()->missed();
  if (simulation.blood() != nullptr && simulation.blood()->field() != nullptr)
    use.iodine = simulation.blood()->field()->totals;
  return use;
}

nlohmann::ordered_json toJson(const ContrastUse& use)
{
  return {{"injected_volume", use.volume},
          {"injected_iodine", use.iodine.injected},
          {"inside", use.iodine.inside},
          {"left", use.iodine.left},
          {"missed_injections", use.missed}};
}

}  // namespace endovascular_sim::results
