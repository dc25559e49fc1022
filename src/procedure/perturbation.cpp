#include "procedure/perturbation.h"

#include <algorithm>
#include <cmath>
#include <random>

#include "common/error.h"

namespace endovascular_sim::procedure
{
namespace
{

/** Even between −1 and 1; unlike the standard's distributions the same on every machine. */
double even(std::mt19937_64& generator)
{
  return std::ldexp(static_cast<double>(generator() >> 11U), -52) - 1.0;
}

}  // namespace

scene::Scene perturbed(scene::Scene scene, const Spread& spread, std::uint64_t seed)
{
  if (seed == 0)
    return scene;
  std::mt19937_64 generator(seed);
  for (scene::DrivenInstrument& driven : scene.instruments)
  {
    const double insertion = driven.drive.initial_insertion + spread.insertion * even(generator);
    // One that is in the introducer at the start stays there, one before it stays outside.
    if (driven.drive.initial_insertion >= 0.0)
      driven.drive.initial_insertion = std::max(0.0, insertion);
    else
      driven.drive.initial_insertion = std::min(driven.drive.initial_insertion, insertion);
    driven.drive.initial_rotation += spread.rotation * even(generator);
  }
  if (!scene.procedure)
    return scene;
  scene.procedure->hand.speed_scale *= 1.0 + spread.speed * even(generator);
  for (scene::StepScene& step : scene.procedure->steps)
    for (double* length : {&step.until.insertion, &step.until.by})
      *length += spread.insertion * even(generator);
  return scene;
}

scene::Scene endingWith(scene::Scene scene, const std::string& phase)
{
  std::vector<scene::StepScene>& steps = scene.procedure->steps;
  std::string current;
  std::string phases;
  std::size_t end = 0;
  for (std::size_t k = 0; k < steps.size(); ++k)
  {
    if (!steps[k].phase.empty() && steps[k].phase != current)
    {
      current = steps[k].phase;
      phases += (phases.empty() ? "" : ", ") + current;
    }
    if (current == phase)
      end = k + 1;
  }
  if (end == 0)
    throw InputError(scene.file, "procedure", "has no phase '" + phase + "'; it has " + phases);
  steps.resize(end);
  return scene;
}

}  // namespace endovascular_sim::procedure
