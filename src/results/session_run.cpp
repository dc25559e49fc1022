#include "results/session_run.h"

#include <algorithm>
#include <array>
#include <cstdio>

#include <nlohmann/json.hpp>

#include "common/output_file.h"
#include "results/metrics_page.h"

namespace endovascular_sim::results
{
SessionRun::SessionRun(const scene::Scene& scene, vessel::Vessel vessel, const Eigen::Vector3d& entry)
  : scene_(scene), vessel_(std::move(vessel)), metrics_(scene, vessel_.centreline, entry)
{
  if (scene_.procedure)
    operator_.emplace(scene_, vessel_.centreline, entry);
}

const std::vector<simulation::HandCommand>& SessionRun::commands(const simulation::Simulation& simulation)
{
  if (operator_)
    return operator_->next(simulation);
  commands_ = simulation::commandsAt(scene_, static_cast<double>(simulation.steps() + 1) * scene_.solver.time_step);
  return commands_;
}

void SessionRun::addStep(const simulation::Simulation& simulation, const std::vector<simulation::WallContact>& contacts)
{
  if (sampler_.addStep(scene_, simulation, contacts))
    metrics_.add(sampler_.sample());
}

void SessionRun::finish(const simulation::Simulation& simulation, const geometry::TriangleMesh* wall)
{
  if (operator_)
    metrics_.setSteps(operator_->records(), operator_->failure());
  metrics_.addTail(sampler_.pending());
  for (const simulation::TimedEvent& event : simulation.events())
    metrics_.addEvent(simulation::nameOf(event.event), event.instrument, event.time);
  metrics_.setLesions(lesionOutcomes(vessel_, wall != nullptr ? *wall : vessel_.mesh, openedStents(simulation)));
}

void SessionRun::write(const std::string& folder) const
{
  writeMetrics(metrics_, folder);
}

std::string instrumentsCsv(const SessionMetrics& metrics)
{
  std::string text =
      "time,instrument,insertion,rotation,pressure,hand_force,hand_torque,peak_hand_force,peak_hand_torque,tip_x,tip_y,"
      "tip_z,branch,depth,tip_rotation\n";
  std::array<char, 400> row{};
  for (const Sample& sample : metrics.samples())
    for (std::size_t k = 0; k < sample.observation.instruments.size(); ++k)
    {
      const procedure::InstrumentView& view = sample.observation.instruments[k];
      std::snprintf(row.data(), row.size(), "%.9g,%s,%.9g,%.9g,%.9g,%.9g,%.9g,%.9g,%.9g,%.9g,%.9g,%.9g,%s,%.9g,%.9g\n",
                    sample.observation.time, metrics.scene().instruments[k].instrument.name.c_str(),
                    view.hand.insertion, view.hand.rotation, view.hand.pressure, view.hand.force, view.hand.torque,
                    sample.peaks.hand_force[k], sample.peaks.hand_torque[k], view.tip.x(), view.tip.y(), view.tip.z(),
                    metrics.locator().name(view.branch_position.branch).c_str(), view.branch_position.depth,
                    view.tip_rotation);
      text += row.data();
    }
  return text;
}

void writeMetrics(const SessionMetrics& metrics, const std::string& folder)
{
  writeTextFile(folder + "/metrics.json", metrics.json().dump(2) + "\n");
  writeTextFile(folder + "/metrics.html", metricsPage(metrics));
  writeTextFile(folder + "/instruments.csv", instrumentsCsv(metrics));
}

}  // namespace endovascular_sim::results
