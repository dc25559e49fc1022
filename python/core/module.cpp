#include <pybind11/pybind11.h>

#include "common/version.h"
#include "errors.h"
#include "hardware.h"
#include "observation.h"
#include "rollout.h"
#include "session.h"
#include "world.h"

PYBIND11_MODULE(_core, module)
{
  using namespace endovascular_sim;  // NOLINT: a module's main file
  module.doc() = "Compiled part of endovascular_sim; use the package endovascular_sim.";
  module.attr("__version__") = version();
  module.attr("commit") = commit();
  module.attr("physics_number") = kPhysicsNumber;
  python::bindErrors(module);
  python::bindReading(module);
  python::bindObservation(module);
  python::bindWorld(module);
  python::bindSession(module);
  python::bindRollout(module);
  for (const char* name : {"Branch", "Cine", "Observation", "Reading", "Rollout", "Session",
                           "World"})  // their public place, e.g. in pickles
    module.attr(name).attr("__module__") = "endovascular_sim";
}
