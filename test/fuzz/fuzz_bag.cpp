#include <sys/mman.h>
#include <unistd.h>

#include <cstdint>
#include <string>

#include "common/error.h"
#include "nodes/conversions/vessel_conversions.h"
#include "nodes/session/session_bag.h"
#include "scene/scene_file.h"

// Bags of the session node, as replay reads them.

using namespace endovascular_sim;  // NOLINT: a program's main file

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size)
{
  const int file = memfd_create("session.bag", 0);
  if (file < 0 || write(file, data, size) != static_cast<ssize_t>(size))
    return 0;
  try
  {
    const nodes::SessionBag session = nodes::readSessionBag("/proc/self/fd/" + std::to_string(file));
    scene::parseRecordedScene(session.info.scene_yaml, "session.bag");
    if (session.mesh)
      nodes::fromMessage(*session.mesh).hash();
    if (session.centreline)
      nodes::fromMessage(*session.centreline);
  }
  catch (const InputError&)
  {
    close(file);
    return 0;
  }
  close(file);
  return 0;
}
