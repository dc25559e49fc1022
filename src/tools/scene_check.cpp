#include <cstdio>
#include <iostream>
#include <string>
#include <vector>

#include "common/error.h"
#include "common/hash.h"
#include "results/session_run.h"
#include "scene/model/scene.h"
#include "scene/scene_file.h"
#include "scene/scene_vessel.h"

namespace
{

constexpr auto kUsage = R"(Checks a scene and prints it complete, with every default and included file.

usage: scene_check SCENE.yaml [--set key.path=value ...] [--vessel] [--nodes | --hash]

  --set key.path=value  replaces a value, e.g. --set drive.speed=0.02 --set instrument.sections.0.radius=0.0003
  --vessel              makes the vessel too, and checks what needs it: the mesh, the entry, branches by their names
  --nodes               prints the nodes that the scene needs instead, one a line
  --hash                prints the scene's hash instead
  --help                prints this

exit code: 0 the scene is good, 1 it is refused (the reason goes to the error stream), 2 wrong use
)";

enum class Output
{
  kScene,
  kNodes,
  kHash,
};

void checkVessel(const endovascular_sim::scene::Scene& scene)
{
  using namespace endovascular_sim;  // NOLINT: inside of one function
  if (!scene.vessel)
    return;
  const vessel::Vessel vessel = scene::buildVessel(*scene.vessel, scene.entry, scene.file, scene::centrelineUse(scene));
  for (const std::string& note : vessel.notes)
    std::cerr << vessel.source << ": " << note << "\n";
  const scene::EntryPose entry = scene::resolveStart(scene, vessel);
  const results::SessionRun goals(scene, vessel, entry.position);
}

int wrongUse(const std::string& reason)
{
  std::cerr << "scene_check: " << reason << "\n" << kUsage;
  return 2;
}

void print(const endovascular_sim::scene::Scene& scene, Output output)
{
  switch (output)
  {
    case Output::kScene:
      std::cout << scene.resolved_yaml;
      break;
    case Output::kNodes:
      for (const std::string& node : endovascular_sim::scene::requiredNodes(scene))
        std::cout << node << "\n";
      break;
    case Output::kHash:
      std::cout << endovascular_sim::Hash64::toHex(scene.hash()) << "\n";
      break;
  }
}

}  // namespace

int main(int argc, char** argv)
{
  std::string file;
  std::vector<std::string> overrides;
  Output output = Output::kScene;
  bool with_vessel = false;
  for (int i = 1; i < argc; ++i)
  {
    const std::string argument = argv[i];
    if (argument == "--help" || argument == "-h")
    {
      std::cout << kUsage;
      return 0;
    }
    if (argument == "--vessel")
      with_vessel = true;
    else if (argument == "--nodes")
      output = Output::kNodes;
    else if (argument == "--hash")
      output = Output::kHash;
    else if (argument == "--set" && i + 1 < argc)
      overrides.emplace_back(argv[++i]);
    else if (argument == "--set")
      return wrongUse("--set needs key.path=value");
    else if (argument.rfind("--", 0) == 0)
      return wrongUse("unknown option " + argument);
    else if (file.empty())
      file = argument;
    else
      return wrongUse("one scene at a time, not also " + argument);
  }
  if (file.empty())
    return wrongUse("needs a scene file");
  try
  {
    const endovascular_sim::scene::Scene scene = endovascular_sim::scene::loadScene(file, overrides);
    if (with_vessel)
      checkVessel(scene);
    print(scene, output);
  }
  catch (const endovascular_sim::InputError& error)
  {
    std::cerr << error.what() << "\n";
    return 1;
  }
  return 0;
}
