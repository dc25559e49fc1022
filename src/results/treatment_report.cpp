#include "results/treatment_report.h"

#include <nlohmann/json.hpp>

namespace endovascular_sim::results
{
namespace
{

using Json = nlohmann::ordered_json;

const char* nameOf(intervention::StentPlacement::State state)
{
  switch (state)
  {
    case intervention::StentPlacement::State::kCrimped:
      return "crimped";
    case intervention::StentPlacement::State::kExpanding:
      return "on_its_balloon";
    case intervention::StentPlacement::State::kPlaced:
      return "placed";
    case intervention::StentPlacement::State::kLost:
      break;
  }
  return "lost";
}

Json toJson(const intervention::LesionReport& report)
{
  Json json = {{"reference_diameter", report.reference_diameter},
               {"least_diameter", report.minimal_diameter},
               {"stenosis", report.stenosis},
               {"stented", report.stented}};
  if (report.stented)
  {
    json["coverage"] = report.coverage;
    json["apposition"] = report.apposition;
    json["placement_error"] = report.placement_error;
  }
  return json;
}

Json toJson(const intervention::StentPlacement& stent)
{
  Json json = {{"state", nameOf(stent.state())},
               {"inner_diameter", stent.innerDiameter()},
               {"length", stent.length()},
               {"over_expanded", stent.overExpanded()}};
  if (!stent.sleeve().axis.empty())
  {
    const Eigen::Vector3d& middle = stent.sleeve().axis[stent.sleeve().axis.size() / 2];
    json["middle"] = {middle.x(), middle.y(), middle.z()};
  }
  return json;
}

/** Report of a lesion with the stent that has the largest coverage. */
intervention::LesionReport best(const vessel::Vessel& vessel, const geometry::TriangleMesh& mesh,
                                const vessel::PlacedLesion& lesion, const std::vector<intervention::RoundBody>& stents)
{
  intervention::LesionReport report = intervention::reportLesion(mesh, vessel.centreline, lesion);
  for (const intervention::RoundBody& stent : stents)
  {
    const intervention::LesionReport with = intervention::reportLesion(mesh, vessel.centreline, lesion, &stent);
    if (!report.stented || with.coverage > report.coverage)
      report = with;
  }
  return report;
}

}  // namespace

bool isOpened(const intervention::StentPlacement& stent)
{
  return stent.state() == intervention::StentPlacement::State::kPlaced ||
         stent.state() == intervention::StentPlacement::State::kExpanding;
}

std::vector<intervention::RoundBody> openedStents(const simulation::Simulation& simulation)
{
  std::vector<intervention::RoundBody> stents;
  for (int k = 0; k < simulation.instruments(); ++k)
  {
    const intervention::Treatment* treatment = simulation.treatment(k);
    if (treatment == nullptr || !treatment->stent())
      continue;
    if (isOpened(*treatment->stent()))
      stents.push_back(treatment->stent()->sleeve());
  }
  return stents;
}

std::vector<LesionOutcome> lesionOutcomes(const vessel::Vessel& vessel, const geometry::TriangleMesh& mesh,
                                          const std::vector<intervention::RoundBody>& stents)
{
  std::vector<LesionOutcome> outcomes;
  for (const vessel::PlacedLesion& lesion : vessel.lesions)
    outcomes.push_back({vessel.centreline.branches[static_cast<std::size_t>(lesion.branch)].name, lesion.middle,
                        intervention::reportLesion(vessel.mesh, vessel.centreline, lesion),
                        best(vessel, mesh, lesion, stents)});
  return outcomes;
}

Json toJson(const std::vector<LesionOutcome>& lesions)
{
  Json list = Json::array();
  for (const LesionOutcome& lesion : lesions)
    list.push_back({{"branch", lesion.branch},
                    {"place", lesion.position},
                    {"before", toJson(lesion.before)},
                    {"after", toJson(lesion.after)}});
  return list;
}

Json toJson(const scene::Scene& scene, const simulation::Simulation& simulation,
            const std::vector<LesionOutcome>& lesions)
{
  const auto instrumentName = [&scene](int k)
  { return scene.instruments[static_cast<std::size_t>(k)].instrument.name; };
  Json events = Json::array();
  for (const simulation::TimedEvent& event : simulation.events())
    events.push_back({{"time", event.time},
                      {"instrument", instrumentName(event.instrument)},
                      {"event", simulation::nameOf(event.event)}});
  Json balloons = Json::array();
  for (int k = 0; k < simulation.instruments(); ++k)
  {
    const intervention::Treatment* treatment = simulation.treatment(k);
    if (treatment == nullptr)
      continue;
    Json balloon = {{"instrument", instrumentName(k)},
                    {"pressure", treatment->inflation().pressure()},
                    {"peak_pressure", treatment->inflation().peakPressure()},
                    {"burst", treatment->inflation().burst()}};
    balloon["stent"] = treatment->stent() ? toJson(*treatment->stent()) : Json(nullptr);
    balloons.push_back(std::move(balloon));
  }
  return {{"events", events}, {"balloons", balloons}, {"lesions", toJson(lesions)}};
}

}  // namespace endovascular_sim::results
