#include "session/scene.h"

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "common/error.h"
#include "common/hash.h"
#include "session/instrument_library.h"
#include "session/scene_paths.h"
#include "session/scene_reader.h"
#include "session/scene_schema.h"
#include "session/scene_writer.h"

namespace endovascular_sim::session
{
namespace
{

SceneNode* fieldOf(SceneNode& map, const std::string& key)
{
  for (auto& field : map.fields)
    if (field.first == key)
      return &field.second;
  return nullptr;
}

/** Replaces the path of a procedure by the file's content. */
void expandProcedure(SceneNode& procedure, const std::string& file)
{
  if (procedure.kind == SceneNode::Kind::kScalar)
    procedure = readSceneTree(findSceneFile(procedure, "procedure", file));
}

/** Replaces the names of instruments and procedures by their files' content, and `vessel: none` by nothing. */
void normalise(SceneNode& root, const std::string& file)
{
  if (SceneNode* instrument = fieldOf(root, "instrument"))
    expandInstrument(*instrument, "instrument", file);
  if (SceneNode* instruments = fieldOf(root, "instruments"))
    for (std::size_t k = 0; k < instruments->items.size(); ++k)
      if (SceneNode* instrument = fieldOf(instruments->items[k], "instrument"))
        expandInstrument(*instrument, "instruments." + std::to_string(k) + ".instrument", file);
  if (SceneNode* procedure = fieldOf(root, "procedure"))
    expandProcedure(*procedure, file);
  for (const char* key : {"vessel", "fluoroscopy"})
  {
    SceneNode* part = fieldOf(root, key);
    if (part != nullptr && part->kind == SceneNode::Kind::kScalar && part->text == "none")
      part->kind = SceneNode::Kind::kNull;
  }
}

/** Files named by the vessel, as absolute paths. The resolved text keeps what was written, so that the scene's hash
 *  does not depend on the machine. */
void resolveVesselPaths(Scene& scene, const SceneNode& root)
{
  const SceneNode* vessel = root.find("vessel");
  if (vessel == nullptr)
    return;
  if (const SceneNode* mesh = vessel->find("mesh"))
    scene.vessel->mesh = findSceneFile(*mesh, "vessel.mesh", scene.file);
  if (const SceneNode* anatomy = vessel->find("anatomy"))
    scene.vessel->anatomy = findSceneFile(*anatomy, "vessel.anatomy", scene.file);
}

enum class VesselFiles
{
  kSought,
  kNotNeeded,
};

Scene buildScene(SceneNode root, const std::string& file, const std::vector<std::string>& overrides,
                 VesselFiles files = VesselFiles::kSought)
{
  normalise(root, file);
  for (const std::string& override_text : overrides)
  {
    overrideSceneTree(root, override_text, file);
    normalise(root, file);
  }
  Scene scene;
  scene.file = file;
  scene.name = std::filesystem::path(file).stem().string();
  SceneReader reader(&root, root, "");
  visitScene(reader, scene);
  reader.finish();
  SceneWriter writer;
  visitScene(writer, scene);
  scene.resolved_yaml = writer.yaml();
  if (files == VesselFiles::kSought)
    resolveVesselPaths(scene, root);
  return scene;
}

}  // namespace

double DriveProfile::at(double t) const
{
  const double sine = amplitude == 0.0 ? 0.0 : amplitude * std::sin(2.0 * M_PI * frequency * t + phase);
  if (points.empty())
    return sine;
  const auto after = std::upper_bound(points.begin(), points.end(), t,
                                      [](double time, const Point& point) { return time < point.time; });
  if (after == points.begin())
    return points.front().value + sine;
  const Point& a = *(after - 1);
  if (after == points.end())
    return a.value + sine;
  return a.value + (after->value - a.value) * ((t - a.time) / (after->time - a.time)) + sine;
}

double DriveScene::insertionAt(double t) const
{
  if (source == DriveSource::kNone)
    return initial_insertion;
  return initial_insertion + (std::isnan(speed) ? insertion.at(t) : std::min(speed * t, travel));
}

double DriveScene::rotationAt(double t) const
{
  return source == DriveSource::kNone ? initial_rotation : initial_rotation + rotation.at(t);
}

double DriveScene::pressureAt(double t) const
{
  return source == DriveSource::kNone ? 0.0 : pressure.at(t);
}

double Scene::longest() const
{
  double length = 0.0;
  for (const DrivenInstrument& driven : instruments)
    length = std::max(length, driven.instrument.wire.length());
  return length;
}

std::uint64_t Scene::hash() const
{
  Hash64 hash;
  hash.add(resolved_yaml);
  return hash.value();
}

Scene loadScene(const std::string& file, const std::vector<std::string>& overrides)
{
  return buildScene(readSceneTree(file), file, overrides);
}

Scene parseScene(const std::string& yaml, const std::string& origin, const std::vector<std::string>& overrides)
{
  return buildScene(parseSceneTree(yaml, origin), origin, overrides);
}

Scene parseRecordedScene(const std::string& yaml, const std::string& origin)
{
  return buildScene(parseSceneTree(yaml, origin), origin, {}, VesselFiles::kNotNeeded);
}

std::vector<std::string> requiredNodes(const Scene& scene)
{
  std::vector<std::string> nodes;
  if (scene.vessel)
    nodes.emplace_back("vessel_server");
  nodes.emplace_back("rod_dynamics");
  if (scene.vessel)
    nodes.emplace_back("contact");
  if (scene.haptic_device)
    nodes.emplace_back("haptic_device");
  if (scene.fluoroscopy)
    nodes.emplace_back("fluoroscopy");
  nodes.emplace_back("session");
  return nodes;
}

}  // namespace endovascular_sim::session
