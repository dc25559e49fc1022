#pragma once

#include "rod/boundary/boundary_conditions.h"
#include "rod/model/discretisation.h"
#include "rod/stepping/stepper.h"

namespace endovascular_sim::rod
{

/** Rod of the `kkt` scheme with its boundary, environment and settings: the data that the parts of the scheme share. */
struct KktModel
{
  KktModel(Discretisation nodes, Boundary holds, Environment surroundings, StepperSettings solver)
    : rod(std::move(nodes)), boundary(std::move(holds)), environment(std::move(surroundings)), settings(solver)
  {
  }
  KktModel(const KktModel&) = delete;  // the conditions refer to other members
  KktModel& operator=(const KktModel&) = delete;

  /** Mass of a node less that of the fluid that it displaces [kg]. */
  double immersedMass(int node) const
  {
    const double displaced =
        environment.fluid_density * M_PI * rod.radius[node] * rod.radius[node] * rod.cell_length[node];
    return rod.mass[node] - displaced;
  }

  /** Drag of the fluid on a node per speed of its surface [N·s/m]; 0 outside the vessel. */
  double dragCoefficient(int node, double speed, const State& state) const
  {
    if (environment.fluid_density <= 0.0 ||
        (boundary.introducer && conditions.bodyPosition(node, state.inserted_length) < 0.0))
      return 0.0;
    return environment.fluid_density * environment.drag_coefficient * rod.radius[node] * rod.cell_length[node] * speed;
  }

  Discretisation rod;
  const Boundary boundary;
  const Environment environment;
  const StepperSettings settings;
  const BoundaryConditions conditions{rod, boundary};
};

}  // namespace endovascular_sim::rod
