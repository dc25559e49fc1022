#include "observation.h"

#include <utility>

#include "arrays.h"
#include "blood.h"
#include "contrast.h"
#include "hardware.h"
#include "patient_motion.h"
#include "zeroed.h"

namespace endovascular_sim::python
{
namespace py = pybind11;
namespace
{

struct Branch : Zeroed
{
  std::string name;
  int index = -1;
  double depth = 0.0;
};

struct Snapshot : Zeroed
{
  std::uint64_t step;
  double time;
  py::array_t<HandRow> hands;
  py::array_t<TipRow> tips;
  py::tuple branches;
  py::array_t<double> nodes;
  py::array_t<ForceRow> forces;
  py::dict sensors;
  py::object blood;
  py::object contrast;
  py::object motion;
};

std::string represented(const Branch& branch)
{
  return "<Branch '" + branch.name + "', depth " + std::to_string(branch.depth) + " m>";
}

}  // namespace

py::object branchOf(const session::Observation& observation, int instrument)
{
  const procedure::BranchPosition at = observation.branch(instrument);
  return py::cast(Branch{{}, observation.branchName(instrument), at.branch, at.depth});
}

py::object snapshotOf(const session::Observation& observation, double time_step)
{
  py::tuple branches(static_cast<std::size_t>(observation.instruments()));
  for (int k = 0; k < observation.instruments(); ++k)
    branches[static_cast<std::size_t>(k)] = branchOf(observation, k);
  return py::cast(Snapshot{{},
                           observation.step(),
                           observation.time(),
                           handsOf(observation),
                           tipsOf(observation),
                           branches,
                           pointArray(observation.nodes(), static_cast<std::size_t>(observation.firstNode())),
                           forcesOf(observation),
                           readingsOf(observation, time_step),
                           bloodOf(observation),
                           contrastOf(observation),
                           motionOf(observation)});
}

void bindObservation(py::module_& module)
{
  bindRows();
  bindBlood(module);
  bindContrast(module);
  bindMotion(module);
  py::class_<Branch>(module, "Branch", "Position in the branches of the vessel.")
      .def_readonly("name", &Branch::name, "Name of the branch; \"outside\" outside of the vessel.")
      .def_readonly("index", &Branch::index, "Index in World.branches; -1 outside of the vessel.")
      .def_readonly("depth", &Branch::depth, "Distance from the ostium along the branch, positive distally [m].")
      .def("__repr__", &represented);
  py::class_<Snapshot>(module, "Observation", "State of a session after a step. The arrays are copies.")
      .def_readonly("step", &Snapshot::step, "Number of steps so far.")
      .def_readonly("time", &Snapshot::time, "Simulated time [s].")
      .def_readonly("hands", &Snapshot::hands, "As Session.hands.")
      .def_readonly("tips", &Snapshot::tips, "As Session.tips.")
      .def_readonly("branches", &Snapshot::branches, "Branch of each instrument's tip, a tuple.")
      .def_readonly("nodes", &Snapshot::nodes, "As Session.nodes.")
      .def_readonly("forces", &Snapshot::forces, "As Session.forces.")
      .def_readonly("sensors", &Snapshot::sensors, "As Session.sensors.")
      .def_readonly("blood", &Snapshot::blood, "As Session.blood.")
      .def_readonly("contrast", &Snapshot::contrast, "As Session.contrast.")
      .def_readonly("motion", &Snapshot::motion, "As Session.motion.");
}

}  // namespace endovascular_sim::python
