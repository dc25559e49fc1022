#include <iostream>
#include <memory>
#include <string>
#include <vector>

#include "common/error.h"
#include "common/hash.h"
#include "common/progress.h"
#include "scene/facets_around.h"
#include "scene/model/scene.h"
#include "scene/numeric_keys.h"
#include "scene/sampling_error.h"
#include "scene/scene_file.h"
#include "session/session.h"
#include "tools/command_line.h"
#include "tools/tool_output.h"

namespace
{

using namespace endovascular_sim;  // NOLINT: a program's main file

struct Options
{
  std::string scene;
  std::vector<std::string> overrides;
  bool vessel = false;
  bool nodes = false;
  bool hash = false;
  bool keys = false;
  bool urdf = false;
};

void addOptions(tools::CommandLine& line, Options& options)
{
  line.argument("SCENE.yaml", options.scene, "scene to check")->required(false);
  line.overrides(options.overrides,
                 "replaces a value, e.g. --set drive.speed=0.02 --set instrument.sections.0.radius=0.0003");
  line.flag(
      "--vessel", options.vessel,
      "also builds the vessel and loads the patient of the X-ray image; checks the mesh, the entry and the branches' "
      "names; prints the expected error of the hand force by the distance of the nodes");
  line.flag("--nodes", options.nodes, "prints the ROS nodes that the scene requires instead, one per line");
  line.flag("--hash", options.hash, "prints the scene's hash instead");
  line.flag("--urdf", options.urdf, "prints the URDF of the scene's robot instead");
  line.flag("--keys", options.keys, "prints all numeric keys with unit, usual and accepted values as a Markdown table");
  line.require([&options] { return options.keys || !options.scene.empty() ? "" : "SCENE.yaml is required"; });
}

/** Prints warnings and notes of a vessel on the error stream. */
void printVessel(const vessel::Vessel& vessel)
{
  tools::printWarnings("scene_check", vessel.warnings);
  tools::printNotes(vessel.source, vessel.notes);
}

/** @throws InputError for a mesh, an entry or a branch that cannot be used */
void checkVessel(const scene::Scene& scene)
{
  if (!scene.vessel)
    return;
  const std::shared_ptr<const session::World> world = session::World::make(scene, progressOnErrorStream(), printVessel);
  const vessel::Vessel& vessel = *world->vessel();
  if (scene.fluoroscopy)
    tools::printNotes("patient", world->patient().notes);
  if (scene.flow)
    tools::printNotes("flow", world->flow().body().remarks());
  const session::Session start(world);  // checks the procedure and the instruments
  std::cerr << "scene_check: " << scene::facetsAround(vessel.mesh).text(scene.vessel->wall) << "\n";
  std::cerr << "scene_check: " << scene::expectedSamplingError(scene, vessel, world->entry()).text() << "\n";
}

int check(const Options& options)
{
  if (options.keys)
  {
    std::cout << scene::numericKeysTable();
    return 0;
  }
  const scene::Scene scene = scene::loadScene(options.scene, options.overrides);
  tools::printWarnings("scene_check", scene.warnings);
  if (options.vessel)
    checkVessel(scene);
  if (options.urdf && !scene.robot)
    throw InputError(scene.file, "robot", "missing; add the robot's URDF and joints (docs/YOUR_ROBOT.md)");
  if (options.urdf)
    std::cout << scene.robot->model.urdf;
  else if (options.hash)
    std::cout << Hash64::toHex(scene.hash()) << "\n";
  else if (options.nodes)
    for (const std::string& node : scene::requiredNodes(scene))
      std::cout << node << "\n";
  else
    std::cout << scene.resolved_yaml;
  return 0;
}

}  // namespace

int main(int argc, char** argv)
{
  Options options;
  tools::CommandLine line("scene_check",
                          "Checks a scene and prints it completely, with all defaults and included files.",
                          "Exit code: 0 the scene is valid; 1 it was rejected (the reason is on the error stream); 2 "
                          "wrong arguments.");
  addOptions(line, options);
  return line.run(argc, argv, [&options] { return check(options); });
}
