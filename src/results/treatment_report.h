#pragma once

#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "intervention/lesion_report.h"
#include "simulation/local_deformable_wall.h"
#include "simulation/simulation.h"
#include "vessel/model/vessel.h"

namespace endovascular_sim::results
{

/** A lesion before and after what was done to it. */
struct LesionOutcome
{
  std::string branch;
  double place = 0.0;  ///< of its middle along the branch [m]
  intervention::LesionReport before, after;
};

/** Whether a balloon has opened a stent, which then holds the wall. */
bool isOpened(const intervention::StentPlacement& stent);

/** Stents that were opened, whether or not they have left their balloons, measured where they are now. */
std::vector<intervention::RoundBody> openedStents(const simulation::Simulation& simulation);

/** Measures every lesion of a vessel; costs some milliseconds each.
 *  @param vessel as it was at the beginning
 *  @param mesh of it as it is now
 *  @param stents in it: of several the one that covers most of a lesion counts */
std::vector<LesionOutcome> lesionOutcomes(const vessel::Vessel& vessel, const geometry::TriangleMesh& mesh,
                                          const std::vector<intervention::RoundBody>& stents);

/** Of every lesion branch, place, and what was measured before and after; SI units. */
nlohmann::ordered_json toJson(const std::vector<LesionOutcome>& lesions);

/** `treatment` of result.json (docs/SIMULATE.md): events, balloons, stents, lesions; SI units. */
nlohmann::ordered_json toJson(const scene::Scene& scene, const simulation::Simulation& simulation,
                              const std::vector<LesionOutcome>& lesions);

}  // namespace endovascular_sim::results
