#include "hardware.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>
#include <vector>

#include <pybind11/numpy.h>
#include <pybind11/stl.h>

#include "common/error.h"
#include "zeroed.h"

namespace endovascular_sim::python
{
namespace py = pybind11;
namespace
{

using Use = OwnedSession::Use;

/** Sample of a sensor; its array is a copy. */
struct Reading : Zeroed
{
  py::array_t<double> values;
  bool valid;
  std::uint64_t sequence;
  std::uint64_t step;
  double time;
};

std::string represented(const Reading& reading)
{
  return "<Reading " + std::to_string(reading.sequence) + " of step " + std::to_string(reading.step) +
         (reading.valid ? ">" : ", invalid>");
}

/** Index of a word.
 *  @throws InputError for an unknown one */
template <typename Enum>
Enum wordOf(const std::string& argument, const std::string& word, const std::vector<std::string>& words)
{
  const auto found = std::find(words.begin(), words.end(), word);
  std::string known;
  for (const std::string& one : words)
    known += (known.empty() ? "" : ", ") + one;
  if (found == words.end())
    throw InputError(argument, word, "is unknown; use one of " + known);
  return static_cast<Enum>(found - words.begin());
}

void addFault(OwnedSession& owner, const py::object& instrument, const std::string& axis, const std::string& kind,
              double amount, const std::optional<double>& duration, double probability, double interval,
              std::uint64_t seed)
{
  const Use session(owner);
  robot::FaultSettings fault;
  fault.instrument = static_cast<std::size_t>(instrumentIndex(session->scene(), instrument));
  fault.axis = wordOf<robot::FaultAxis>("axis", axis, robot::axisWords());
  fault.kind = wordOf<robot::FaultKind>("kind", kind, robot::faultWords());
  fault.amount = amount;
  fault.start = session->observe().time();
  if (duration)
    fault.end = fault.start + *duration;
  fault.probability = probability;
  fault.interval = interval;
  fault.seed = seed;
  if (const std::string refusal = robot::refusalOf(fault); !refusal.empty())
    throw InputError("fault", kind, "is impossible: " + refusal);
  session->addFault(fault);
}

std::size_t removeFaults(OwnedSession& owner, const py::object& instrument, const std::string& axis)
{
  const Use session(owner);
  return session->removeFaults(instrumentIndex(session->scene(), instrument),
                               wordOf<robot::FaultAxis>("axis", axis, robot::axisWords()));
}

py::list faultsOf(OwnedSession& owner)
{
  const Use session(owner);
  py::list faults;
  for (const robot::FaultSettings& fault : session->faults().settings())
  {
    py::dict entry;
    entry["instrument"] = session->scene().instruments[fault.instrument].instrument.name;
    entry["axis"] = robot::axisWords()[static_cast<std::size_t>(fault.axis)];
    entry["kind"] = robot::faultWords()[static_cast<std::size_t>(fault.kind)];
    entry["amount"] = fault.amount;
    entry["start"] = fault.start;
    entry["end"] = fault.end;
    entry["probability"] = fault.probability;
    entry["interval"] = fault.interval;
    entry["seed"] = fault.seed;
    faults.append(entry);
  }
  return faults;
}

}  // namespace

py::dict readingsOf(const session::Observation& observation, double time_step)
{
  const simulation::Sensors& sensors = observation.sensors();
  py::dict readings;
  for (std::size_t k = 0; k < sensors.size(); ++k)
  {
    const sensor::Reading& reading = sensors.reading(k);
    readings[py::str(sensors.settings(k).name)] =
        py::cast(Reading{{},
                         py::array_t<double>(static_cast<py::ssize_t>(reading.values.size()), reading.values.data()),
                         reading.valid,
                         reading.sequence,
                         reading.step,
                         static_cast<double>(reading.step) * time_step});
  }
  return readings;
}

void bindReading(py::module_& module)
{
  py::class_<Reading>(module, "Reading", "Newest delivered sample of a sensor.")
      .def_readonly("values", &Reading::values,
                    "Values of the newest valid sample, zeros before the first one; a copy. em_tracker [7]: position "
                    "[m] and quaternion x, y, z, w in the patient frame; encoder [2]: insertion [m], rotation [rad]; "
                    "force_sensor [2]: force [N], torque [N m]; detector [2]: column, row [pixel].")
      .def_readonly("valid", &Reading::valid, "False if this sample was lost, or there was nothing to measure.")
      .def_readonly("sequence", &Reading::sequence,
                    "Number of the sample, from 1, lost ones included; 0 before the first.")
      .def_readonly("step", &Reading::step, "Step after which it was measured.")
      .def_readonly("time", &Reading::time, "Simulated time of the measurement [s].")
      .def("__repr__", &represented);
}

void bindHardware(py::class_<OwnedSession, std::shared_ptr<OwnedSession>>& bound)
{
  bound
      .def_property_readonly(
          "sensors",
          [](OwnedSession& self)
          {
            const Use session(self);
            return readingsOf(session->observe(), session->scene().solver.time_step);
          },
          "Newest delivered samples of the scene's sensors, a dictionary from name to Reading; copies.")
      .def_property_readonly("faults", &faultsOf,
                             "Faults of the robot, those of the scene and added ones, a list of dictionaries.")
      .def("add_fault", &addFault, py::arg("instrument"), py::arg("axis"), py::arg("kind"), py::arg("amount") = 0.0,
           py::arg("duration") = py::none(), py::arg("probability") = 1.0, py::arg("interval") = 0.1,
           py::arg("seed") = 0, R"(
Adds a fault of the robot's drive, which acts on commands from the next step on.

instrument   index or name
axis         insertion or rotation
kind         stuck, slipping, delayed or backlash
amount       share of the motion that slips [1], delay [s], or play [m or rad]; 0 when stuck
duration     [s]; None: until reset() or remove_faults()
probability  that an interval [s] of this time is faulty [1]
seed         selects these intervals, beside noise_seed and the seed of the scene

Faults are part of a saved state. Raises InputError for unknown words and impossible values.)")
      .def("remove_faults", &removeFaults, py::arg("instrument"), py::arg("axis"),
           "Removes all faults of an axis, and returns their number. Motion that has slipped stays lost.")
      .def_property(
          "noise_seed", [](OwnedSession& self) { return Use(self)->noiseSeed(); },
          [](OwnedSession& self, std::uint64_t seed) { Use(self)->setNoiseSeed(seed); },
          "Seed of the errors and losses of sensors and of the faulty intervals, beside the seed of the scene. That of "
          "reset() at first; another one applies to later steps.");
}

}  // namespace endovascular_sim::python
