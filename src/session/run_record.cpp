#include "session/run_record.h"

#include <utility>

#include "common/output_file.h"
#include "results/metrics_files.h"
#include "results/treatment_report.h"
#include "results/wall_force_report.h"
#include "simulation/local_deformable_wall.h"

namespace endovascular_sim::session
{

RunRecord::RunRecord(std::shared_ptr<const World> world, std::shared_ptr<const scene::Scene> scene,
                     std::size_t expected_steps)
  : world_(std::move(world)), scene_(std::move(scene)), result_(*scene_, world_->meshHash(), expected_steps)
{
  if (world_->vessel() == nullptr)
    return;
  metrics_.emplace(*scene_, world_->vessel()->centreline, world_->entry().position);
  wall_forces_.emplace(scene_->record.wall_force_threshold, *world_->vessel());
}

void RunRecord::addStep(const simulation::Simulation& simulation, const std::vector<simulation::WallContact>& contacts,
                        double seconds)
{
  if (isFinished())
    return;
  result_.addStep(simulation, seconds);
  if (!metrics_)
    return;
  results::addStep(*wall_forces_, simulation, contacts, scene_->solver.time_step);
  if (sampler_.addStep(*scene_, simulation, contacts))
    metrics_->add(sampler_.sample());
  if (simulation.blood() != nullptr && simulation.blood()->field() != nullptr)
    metrics_->addBeat(simulation.blood()->field()->means);
}

void RunRecord::finish(const simulation::Simulation& simulation, const procedure::Operator* scripted,
                       const geometry::TriangleMesh& wall)
{
  std::vector<results::LesionOutcome> lesions;
  if (metrics_)
  {
    metrics_->setWallForces(wall_forces_->summary());
    if (scripted != nullptr)
      metrics_->setSteps(scripted->records(), scripted->failure());
    metrics_->addTail(sampler_.pending());
    for (const simulation::TimedEvent& event : simulation.events())
      metrics_->addEvent(simulation::nameOf(event.event), event.instrument, event.time);
    lesions = results::lesionOutcomes(*world_->vessel(), wall, results::openedStents(simulation));
    metrics_->setLesions(lesions);
    if (simulation.contrast() != nullptr)
      metrics_->setContrast(results::contrastUseOf(simulation));
  }
  if (simulation::hasBalloon(*scene_))
    result_.setTreatment(*scene_, simulation, lesions);
  json_ = result_.json(simulation, wallForces());
}

void RunRecord::write(const std::string& folder, RecordFiles files) const
{
  if (files == RecordFiles::kAll)
  {
    writeTextFile(folder + "/result.json", json_);
    writeTextFile(folder + "/scene.yaml", scene_->resolved_yaml);
  }
  if (!metrics_)
    return;
  if (files == RecordFiles::kAll)
  {
    std::vector<results::WallForceRow> rows;
    for (const results::WallForce& force : wall_forces_->touched())
      rows.push_back({force, wall_forces_->centre(force.triangle), wall_forces_->regionName(force.region)});
    writeTextFile(folder + "/wall_forces.csv", results::wallForcesCsv(std::move(rows)));
    writeTextFile(folder + "/vessel_points.csv", results::vesselPointsCsv(world_->vessel()->mesh.vertices));
  }
  results::writeMetrics(*metrics_, folder);
}

}  // namespace endovascular_sim::session
