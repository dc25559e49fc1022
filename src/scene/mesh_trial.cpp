#include "scene/mesh_trial.h"

#include "common/error.h"
#include "scene/file_search.h"
#include "scene/model/scene.h"
#include "scene/scene_file.h"
#include "scene/scene_vessel.h"
#include "vessel/centreline/centreline.h"

namespace endovascular_sim::scene
{
namespace
{

/** Text in single quotes of YAML. */
std::string quoted(const std::string& text)
{
  std::string result = "'";
  for (const char c : text)
    result += c == '\'' ? "''" : std::string(1, c);
  return result + "'";
}

}  // namespace

MeshTrial tryMesh(const std::string& mesh, const std::string& centreline)
{
  Scene scene = loadScene(configFolder() + "/scenes/mesh.yaml",
                          {"vessel.mesh=" + quoted(mesh), "vessel.unit=1", "vessel.centreline=" + quoted(centreline)});
  const vessel::Vessel vessel = buildVessel(*scene.vessel, scene.entry, scene.file, centrelineUse(scene));
  MeshTrial trial;
  trial.warnings = vessel.warnings;
  std::vector<Eigen::Vector3d> entries{scene.entry.position};
  for (const vessel::CentrelineEnd& end : vessel::centrelineEnds(vessel.centreline))
    entries.push_back(end.position);
  std::string reason;
  for (const Eigen::Vector3d& entry : entries)
    try
    {
      scene.entry.position = entry;
      resolveStart(scene, vessel);
      if (&entry != &entries.front())
        trial.entry = entry;
      return trial;
    }
    catch (const InputError& error)
    {
      if (reason.empty())
        reason = error.what();
    }
  throw InputError(mesh, "", "no wire can start at any of its ends: " + reason);
}

}  // namespace endovascular_sim::scene
