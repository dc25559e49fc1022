#include "simulation/offline_session.h"

#include <cmath>
#include <filesystem>

#include "scene/scene_file.h"
#include "scene/scene_vessel.h"
#include "scene/yaml/file_search.h"

namespace endovascular_sim::simulation
{
namespace
{

/** @p scene, or the bundled scene of that name where there is no such file. */
std::string sceneFile(const std::string& scene)
{
  const std::string bundled = scene::configFolder() + "/scenes/" + scene + ".yaml";
  std::error_code error;
  return !std::filesystem::exists(scene, error) && std::filesystem::exists(bundled, error) ? bundled : scene;
}

}  // namespace

OfflineSession::OfflineSession(const std::string& scene, const std::vector<std::string>& overrides,
                               const ProgressReport& progress)
  : scene_(scene::loadScene(sceneFile(scene), overrides))
{
  scene::EntryPose entry;
  const vessel::CentrelineTree* centreline = nullptr;
  if (scene_.vessel)
  {
    vessel_ = std::make_unique<vessel::Vessel>(
        scene::buildVessel(*scene_.vessel, scene_.entry, scene_.file, scene::centrelineUse(scene_), progress));
    entry = scene::resolveStart(scene_, *vessel_);
    detector_ = std::make_unique<contact::Detector>(vessel_->mesh, scene::wallLaw(*scene_.vessel));
    wall_ = makeLocalDeformableWall(scene_, *vessel_, *detector_);
    centreline = &vessel_->centreline;
  }
  else
    entry = scene::resolveEntry(scene_.entry, scene_.file);
  simulation_ = std::make_unique<Simulation>(scene_, entry, detector_.get(), centreline, wall_.get());
}

void OfflineSession::step()
{
  const auto next = static_cast<double>(simulation_->steps() + 1);
  simulation_->stepAll(commandsAt(scene_, next * scene_.solver.time_step));
}

bool OfflineSession::isOver() const
{
  return static_cast<long long>(simulation_->steps()) >= std::llround(scene_.duration / scene_.solver.time_step);
}

}  // namespace endovascular_sim::simulation
