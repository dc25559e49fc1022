#pragma once

#include <optional>
#include <vector>

#include <Eigen/Core>

#include "procedure/branch_places.h"
#include "scene/model/scene.h"
#include "simulation/simulation.h"

namespace endovascular_sim::procedure
{

/** What a person sees and feels of one instrument. */
struct InstrumentView
{
  simulation::HandState hand;
  bool outside = false;                           ///< it has left the introducer
  bool covered = false;                           ///< its tip lies inside of another instrument
  Eigen::Vector3d tip = Eigen::Vector3d::Zero();  ///< patient frame; of an instrument outside, the introducer [m]
  BranchPlace place;                              ///< of the tip
  std::optional<Eigen::Vector3d> balloon;         ///< the middle of the balloon, where one is in the vessel [m]
};

/** What a person sees and feels at a moment. */
struct Observation
{
  double time = 0.0;  ///< [s]
  std::vector<InstrumentView> instruments;
};

/** A point of the instruments' common line at a length beyond the introducer, in front of it for negative ones [m]. */
Eigen::Vector3d pointAt(const simulation::Simulation& simulation, double inserted);

/** Tells which tips lie inside of another instrument, from the insertions. */
void markCovered(Observation& seen);

/** Looks at a simulation. */
Observation observe(const scene::Scene& scene, const simulation::Simulation& simulation, const BranchPlaces& places);

}  // namespace endovascular_sim::procedure
