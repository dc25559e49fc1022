#include "procedure/perturbation.h"

#include <algorithm>
#include <cmath>
#include <random>

#include "common/error.h"

namespace endovascular_sim::procedure
{
namespace
{

/** Uniform random number in [−1, 1); unlike std::uniform_real_distribution, it is equal on all machines. */
double uniform(std::mt19937_64& generator)
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
    const double insertion = driven.drive.initial_insertion + spread.insertion * uniform(generator);
    // The perturbation does not move an instrument across the introducer.
    if (driven.drive.initial_insertion >= 0.0)
      driven.drive.initial_insertion = std::max(0.0, insertion);
    else
      driven.drive.initial_insertion = std::min(driven.drive.initial_insertion, insertion);
    driven.drive.initial_rotation += spread.rotation * uniform(generator);
  }
  if (!scene.procedure)
    return scene;
  scene.procedure->hand.speed_scale *= 1.0 + spread.speed * uniform(generator);
  for (scene::StepScene& step : scene.procedure->steps)
    for (double* length : {&step.until.insertion, &step.until.by})
      *length += spread.insertion * uniform(generator);
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
    throw InputError(scene.file, "procedure", "has no phase '" + phase + "'; known: " + phases);
  steps.resize(end);
  return scene;
}

}  // namespace endovascular_sim::procedure
