#include "session/world.h"

#include <filesystem>
#include <stdexcept>
#include <utility>

#include "scene/file_search.h"
#include "scene/scene_file.h"
#include "simulation/x_ray_patient.h"

namespace endovascular_sim::session
{
namespace
{

/** @p scene, or the bundled scene of that name where there is no such file. */
std::string sceneFile(const std::string& scene)
{
  const std::string bundled = scene::configFolder() + "/scenes/" + scene + ".yaml";
  std::error_code error;
  // A folder of results may have the name of its scene.
  return !std::filesystem::is_regular_file(scene, error) && std::filesystem::exists(bundled, error) ? bundled : scene;
}

std::optional<vessel::Vessel> vesselOf(const scene::Scene& scene, const ProgressReport& progress)
{
  if (!scene.vessel)
    return std::nullopt;
  const scene::CentrelineUse use = scene.procedure ? scene::CentrelineUse::kRequired : scene::centrelineUse(scene);
  return scene::buildVessel(*scene.vessel, scene.entry, scene.file, use, progress);
}

}  // namespace

std::shared_ptr<const World> World::open(const std::string& scene, const std::vector<std::string>& overrides,
                                         const ProgressReport& progress)
{
  return make(scene::loadScene(sceneFile(scene), overrides), progress);
}

std::shared_ptr<const World> World::parse(const std::string& yaml, const std::string& origin,
                                          const std::vector<std::string>& overrides, const ProgressReport& progress)
{
  return make(scene::parseScene(yaml, origin, overrides), progress);
}

std::shared_ptr<const World> World::make(scene::Scene scene, const ProgressReport& progress,
                                         const std::function<void(const vessel::Vessel&)>& prepared)
{
  std::optional<vessel::Vessel> vessel = vesselOf(scene, progress);
  if (vessel && prepared)
    prepared(*vessel);
  std::shared_ptr<const World> world(new World(std::move(scene), std::move(vessel)));
  if (world->vessel() != nullptr)
    reportProgress(progress, "search tree of the wall");
  world->wall();
  return world;
}

std::shared_ptr<const World> World::make(scene::Scene scene, std::optional<vessel::Vessel> vessel)
{
  return std::shared_ptr<const World>(new World(std::move(scene), std::move(vessel)));
}

std::shared_ptr<const World> World::make(scene::Scene scene, std::shared_ptr<const vessel::Vessel> vessel,
                                         std::shared_ptr<const contact::WallModel> wall, const scene::EntryPose& entry)
{
  if (!vessel || !wall || !scene.vessel)
    throw std::invalid_argument("World: needs a vessel, its wall and a scene with a vessel");
  return std::shared_ptr<const World>(new World(std::move(scene), std::move(vessel), std::move(wall), entry));
}

std::shared_ptr<const World> World::with(scene::Scene scene) const
{
  std::shared_ptr<const World> made = make(std::move(scene), vessel_, wall(), entry_);
  made->requireStart(made->scene());
  return made;
}

World::World(scene::Scene scene, std::optional<vessel::Vessel> vessel) : scene_(std::move(scene))
{
  if (!vessel)
  {
    entry_ = scene::resolveEntry(scene_.entry, scene_.file);
    return;
  }
  entry_ = scene::resolveStart(scene_, *vessel);
  mesh_hash_ = vessel->mesh.hash();
  vessel_ = std::make_shared<const vessel::Vessel>(std::move(*vessel));
}

World::World(scene::Scene scene, std::shared_ptr<const vessel::Vessel> vessel,
             std::shared_ptr<const contact::WallModel> wall, const scene::EntryPose& entry)
  : scene_(std::move(scene)),
    vessel_(std::move(vessel)),
    mesh_hash_(vessel_->mesh.hash()),
    entry_(entry),
    wall_(std::move(wall))
{
}

const std::shared_ptr<const contact::WallModel>& World::wall() const
{
  std::call_once(wall_prepared_,
                 [this]
                 {
                   if (!wall_ && vessel_)
                     wall_ = contact::WallModel::create(vessel_->mesh, scene_.vessel->wall);
                 });
  return wall_;
}

const std::shared_ptr<const procedure::BranchLocator>& World::branches() const
{
  std::call_once(branches_known_,
                 [this]
                 {
                   branches_ = std::make_shared<const procedure::BranchLocator>(
                       vessel_ ? vessel_->centreline : vessel::CentrelineTree(),
                       scene_.procedure ? scene_.procedure->branches : std::vector<scene::NamedBranch>());
                 });
  return branches_;
}

const flow::FlowEngine& World::flow() const
{
  if (!scene_.flow || !vessel_)
    throw std::logic_error("World: the scene has no flow");
  std::call_once(flow_known_,
                 [this]
                 {
                   flow_ = std::make_unique<const flow::FlowEngine>(
                       simulation::makeFlowEngine(scene_, *vessel_, scene_.contrast ? &contrastVessel() : nullptr));
                 });
  return *flow_;
}

const simulation::ContrastVessel& World::contrastVessel() const
{
  if (!scene_.contrast || !scene_.flow || !vessel_)
    throw std::logic_error("World: the scene has no contrast medium");
  std::call_once(contrast_known_,
                 [this] { contrast_vessel_ = std::make_unique<const simulation::ContrastVessel>(scene_, *vessel_); });
  return *contrast_vessel_;
}

std::shared_ptr<const simulation::BloodVessel> World::bloodVessel() const
{
  if (!scene_.flow || !vessel_)
    throw std::logic_error("World: the scene has no flow");
  std::call_once(tree_known_,
                 [this] { blood_vessel_ = std::make_shared<const simulation::BloodVessel>(scene_, *vessel_); });
  return blood_vessel_;
}

const simulation::PatientMotion& World::motion() const
{
  if (!scene_.motion || !vessel_)
    throw std::logic_error("World: the scene has no motion");
  std::call_once(motion_known_,
                 [this]
                 {
                   motion_ = std::make_unique<const simulation::PatientMotion>(
                       simulation::makePatientMotion(scene_, *vessel_, entry_));
                 });
  return *motion_;
}

const XRayVolume& World::patient() const
{
  std::call_once(patient_loaded_,
                 [this]
                 {
                   patient::PatientVolume loaded =
                       simulation::patientVolume(scene_, vessel_ ? *vessel_ : vessel::Vessel());
                   if (loaded.volume)
                     patient_.projection = std::make_shared<const fluoroscopy::VolumeProjection>(*loaded.volume);
                   patient_.notes = std::move(loaded.notes);
                 });
  return patient_;
}

void World::requireStart(const scene::Scene& scene) const
{
  if (!vessel_)
    return;
  std::call_once(free_length_known_, [this] { free_length_ = scene::freeLength(entry_, *vessel_); });
  scene::requireFreeStart(scene, free_length_);
}

}  // namespace endovascular_sim::session
