#include <cstdint>
#include <cstdlib>
#include <iostream>
#include <string>

#include "common/error.h"
#include "scene/scene_file.h"

// Texts of scene files. An accepted scene is complete: its resolved text is accepted and gives the same scene.

using namespace endovascular_sim;  // NOLINT: a program's main file

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size)
{
  const std::string origin = PROJECT_DIR "/config/scenes/fuzzed.yaml";
  try
  {
    const scene::Scene scene = scene::parseScene({reinterpret_cast<const char*>(data), size}, origin);
    try
    {
      if (scene::parseScene(scene.resolved_yaml, origin).hash() != scene.hash())
        std::abort();
    }
    catch (const InputError& error)
    {
      std::cerr << error.what() << "\n" << scene.resolved_yaml;
      std::abort();
    }
  }
  catch (const InputError&)
  {
    return 0;
  }
  return 0;
}
