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

/** Measurements of a lesion before and after the treatment. */
struct LesionOutcome
{
  std::string branch;
  double position = 0.0;  ///< arc length of the lesion's centre on the branch [m]
  intervention::LesionReport before, after;
};

/** True if a balloon has expanded the stent, so that the stent supports the wall. */
bool isOpened(const intervention::StentPlacement& stent);

/** Present shapes of the expanded stents, on or off their balloons. */
std::vector<intervention::RoundBody> openedStents(const simulation::Simulation& simulation);

/** Measures all lesions of a vessel, at a cost of some milliseconds each.
 *  @param vessel vessel before the treatment
 *  @param mesh present mesh of the vessel
 *  @param stents expanded stents; the one with the largest coverage of a lesion counts for it */
std::vector<LesionOutcome> lesionOutcomes(const vessel::Vessel& vessel, const geometry::TriangleMesh& mesh,
                                          const std::vector<intervention::RoundBody>& stents);

/** Lesions as JSON: branch, position, and measurements before and after; SI units. */
nlohmann::ordered_json toJson(const std::vector<LesionOutcome>& lesions);

/** Value of `treatment` in result.json (docs/SIMULATE.md): events, balloons, stents, lesions; SI units. */
nlohmann::ordered_json toJson(const scene::Scene& scene, const simulation::Simulation& simulation,
                              const std::vector<LesionOutcome>& lesions);

}  // namespace endovascular_sim::results
