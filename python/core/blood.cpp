#include "blood.h"

#include <optional>

#include <pybind11/numpy.h>
#include <pybind11/stl.h>

#include "arrays.h"
#include "common/error.h"
#include "errors.h"
#include "zeroed.h"

namespace endovascular_sim::python
{
namespace py = pybind11;
namespace
{

/** Pressure and flow in the vessel, valid for ever. */
struct Blood : Zeroed
{
  double phase, ventricle, mean_root;
  std::uint32_t beats;
  py::array_t<double> readings, mean_readings, mean_behind_lesions;
  py::array_t<double> pressures, flows, areas;
};

py::array_t<double> arrayOf(const std::vector<double>& values)
{
  return py::array_t<double>(static_cast<py::ssize_t>(values.size()), values.data());
}

/** Values of the pressure lines by instrument; NaN without a line. */
py::array_t<double> byInstrument(const session::Observation& observation, const std::vector<double>& of_lines)
{
  const simulation::BloodCoupling& blood = *observation.simulation().blood();
  py::array_t<double> values(static_cast<py::ssize_t>(observation.instruments()));
  for (int k = 0; k < observation.instruments(); ++k)
  {
    const int line = blood.lineOf(k);
    values.mutable_at(k) = line < 0 ? std::nan("") : of_lines.at(static_cast<std::size_t>(line));
  }
  return values;
}

py::dict controlsOf(const flow::FlowControls& controls)
{
  py::dict found;
  found["heart_rate"] = controls.heart_rate;
  found["mean_pressure"] = controls.mean_pressure;
  found["hyperaemia"] = controls.hyperaemia;
  return found;
}

void requireFlow(const session::Session& session)
{
  if (session.simulation().blood() == nullptr)
    throw UsageError("blood does not flow in this scene; give it the key flow, e.g. flow='adult'");
}

void setFlow(OwnedSession& owner, const std::optional<double>& heart_rate, const std::optional<double>& mean_pressure,
             const std::optional<bool>& hyperaemia)
{
  const OwnedSession::Use session(owner);
  requireFlow(*session);
  flow::FlowControls controls = session->flowControls();
  controls.heart_rate = heart_rate.value_or(controls.heart_rate);
  controls.mean_pressure = mean_pressure.value_or(controls.mean_pressure);
  controls.hyperaemia = hyperaemia.value_or(controls.hyperaemia);
  if (const std::string refusal = flow::refusalOf(controls); !refusal.empty())
    throw InputError("set_flow", "", refusal);
  session->setFlowControls(controls);
}

template <double (session::Observation::*value)(const Eigen::Vector3d&) const>
double valueAt(OwnedSession& owner, const std::array<double, 3>& point)
{
  const OwnedSession::Use session(owner);
  requireFlow(*session);
  return (session->observe().*value)({point[0], point[1], point[2]});
}

}  // namespace

py::object bloodOf(const session::Observation& observation)
{
  const flow::FlowField* field = observation.blood();
  if (field == nullptr)
    return py::none();
  const bool has_means = field->means.root > 0.0;
  return py::cast(Blood{{},
                        field->phase,
                        field->ventricle,
                        has_means ? field->means.root : std::nan(""),
                        field->beats,
                        byInstrument(observation, field->readings),
                        byInstrument(observation, field->means.readings),
                        arrayOf(field->means.lesions),
                        arrayOf(field->pressures),
                        arrayOf(field->flows),
                        arrayOf(field->areas)});
}

void bindBlood(py::module_& module)
{
  py::class_<Blood>(module, "Blood", "Pressure and flow of the blood. The arrays are copies.")
      .def_readonly("phase", &Blood::phase, "Phase of the beat, 0 to 1 from the opening of the aortic valve.")
      .def_readonly("beats", &Blood::beats, "Number of complete beats.")
      .def_readonly("ventricle", &Blood::ventricle, "Pressure in the left ventricle [Pa].")
      .def_readonly("readings", &Blood::readings,
                    "Pressure at each instrument's opening through its line [instrument] [Pa]; NaN without a line.")
      .def_readonly("mean_root", &Blood::mean_root, "Mean pressure at the inlet of the vessel in the last beat [Pa].")
      .def_readonly("mean_readings", &Blood::mean_readings, "Mean of the readings in the last beat [instrument] [Pa].")
      .def_readonly("mean_behind_lesions", &Blood::mean_behind_lesions,
                    "Mean pressure behind each lesion in the last beat [lesion] [Pa].")
      .def_readonly("pressures", &Blood::pressures, "Pressure at each node of the flow network [Pa].")
      .def_readonly("flows", &Blood::flows, "Flow through each cell, positive away from the heart [m^3/s].")
      .def_readonly("areas", &Blood::areas, "Free lumen of each cell [m^2].");
}

void bindBlood(py::class_<OwnedSession, std::shared_ptr<OwnedSession>>& session)
{
  session
      .def_property_readonly(
          "blood",
          [](OwnedSession& self)
          {
            const OwnedSession::Use used(self);
            return bloodOf(used->observe());
          },
          "Pressure and flow of the blood, a copy; None without the key flow, and before its first step.")
      .def_property_readonly(
          "flow",
          [](OwnedSession& self) -> py::object
          {
            const OwnedSession::Use used(self);
            if (used->simulation().blood() == nullptr)
              return py::none();
            return controlsOf(used->flowControls());
          },
          "Heart rate [Hz], mean pressure [Pa] and hyperaemia, a dictionary; None without the key flow.")
      .def("set_flow", &setFlow, py::arg("heart_rate") = py::none(), py::arg("mean_pressure") = py::none(),
           py::arg("hyperaemia") = py::none(), R"(
Changes the circulation from its next step on; what is not given stays.

heart_rate     0: arrest, or 0.333 to 5 [Hz]
mean_pressure  2e3 to 4e4 [Pa]
hyperaemia     True: small vessels of the heart's muscle dilated, as by adenosine

Raises InputError for other values, and UsageError in a scene without the key flow.)")
      .def(
          "blood_flow", &valueAt<&session::Observation::bloodFlow>, py::arg("point"),
          "Flow at a point of the vessel, positive away from the heart [m^3/s]; NaN before the first step of the flow.")
      .def("blood_pressure", &valueAt<&session::Observation::bloodPressure>, py::arg("point"),
           "Pressure of the blood at a point of the vessel [Pa]; NaN before the first step of the flow.");
}

}  // namespace endovascular_sim::python
