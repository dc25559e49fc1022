#include "patient_motion.h"

#include <optional>

#include <pybind11/numpy.h>
#include <pybind11/stl.h>

#include "common/error.h"
#include "errors.h"
#include "zeroed.h"

namespace endovascular_sim::python
{
namespace py = pybind11;
namespace
{

using Points = py::array_t<double, py::array::c_style | py::array::forcecast>;

/** Motion of the patient after a step, valid for ever. */
struct Motion : Zeroed
{
  double heart_phase, heart_rate;
  bool systole;
  double breath_phase, breathing_rate;
  bool breath_held;
  double diaphragm;
  motion::MotionControls controls;
  motion::MotionMap map;
};

py::dict controlsOf(const Motion& motion)
{
  py::dict found;
  found["heart_rate"] = motion.controls.heart_rate;
  found["breathing_rate"] = motion.controls.breathing_rate;
  found["breath_held"] = motion.controls.breath_held;
  return found;
}

/** Values of a function of the map at a point [3], or at points [point, 3]. */
template <Eigen::Vector3d (motion::MotionMap::*value)(const Eigen::Vector3d&) const>
py::array_t<double> valuesAt(const Motion& motion, const Points& points)
{
  const py::ssize_t n = points.ndim();
  if ((n != 1 && n != 2) || points.shape(n - 1) != 3)
    throw InputError("points", "", "must be a point [3] or an array of points [point, 3] [m]");
  py::array_t<double> values(std::vector<py::ssize_t>(points.shape(), points.shape() + n));
  for (py::ssize_t k = 0; k < points.size(); k += 3)
  {
    const Eigen::Map<const Eigen::Vector3d> point(points.data() + k);
    Eigen::Map<Eigen::Vector3d>(values.mutable_data() + k) = (motion.map.*value)(point);
  }
  return values;
}

std::string represented(const Motion& motion)
{
  return "<Motion heart " + std::to_string(motion.heart_phase) + " of a beat, breath " +
         std::to_string(motion.breath_phase) + " of a breath>";
}

void setMotion(OwnedSession& owner, const std::optional<double>& heart_rate,
               const std::optional<double>& breathing_rate, const std::optional<bool>& breath_held)
{
  const OwnedSession::Use session(owner);
  if (session->simulation().motion() == nullptr)
    throw UsageError("the patient of this scene does not move; give it the key motion, e.g. motion='adult'");
  motion::MotionControls controls = session->motionControls();
  controls.heart_rate = heart_rate.value_or(controls.heart_rate);
  controls.breathing_rate = breathing_rate.value_or(controls.breathing_rate);
  controls.breath_held = breath_held.value_or(controls.breath_held);
  if (const std::string refusal = session->refusalOf(controls); !refusal.empty())
    throw InputError("set_motion", "", refusal);
  session->setMotionControls(controls);
}

}  // namespace

py::object motionOf(const session::Observation& observation)
{
  const motion::MovingPatient* patient = observation.motion();
  if (patient == nullptr)
    return py::none();
  return py::cast(Motion{{},
                         patient->heart().phase(),
                         patient->heart().rate(),
                         patient->systole(),
                         patient->breath().phase(),
                         patient->breath().rate(),
                         patient->breath().standing(),
                         patient->diaphragm(),
                         patient->controls(),
                         patient->map()});
}

void bindMotion(py::module_& module)
{
  py::class_<Motion>(module, "Motion", R"(
Motion of the patient after a step, a copy: phases, and the map from the resting patient to the moved one.

World.vertices and World.branches are those of the resting patient; positions of instruments are in the moved one.)")
      .def_readonly("heart_phase", &Motion::heart_phase, "Phase of the beat, 0 to 1 from end-diastole.")
      .def_readonly("heart_rate", &Motion::heart_rate, "Rate of the present beat [Hz].")
      .def_readonly("systole", &Motion::systole, "True from end-diastole to end-systole.")
      .def_readonly("breath_phase", &Motion::breath_phase, "Phase of the breath, 0 to 1 from end-expiration.")
      .def_readonly("breathing_rate", &Motion::breathing_rate, "Rate of the present breath [Hz].")
      .def_readonly("breath_held", &Motion::breath_held, "True while the breath is held, at end-expiration.")
      .def_readonly("diaphragm", &Motion::diaphragm, "Displacement of the diaphragm towards the feet [m].")
      .def_property_readonly("controls", &controlsOf,
                             "Values of Session.set_motion() that act from the next beat or breath on, a dictionary.")
      .def("position", &valuesAt<&motion::MotionMap::position>, py::arg("points"),
           "Places in the moved patient of points at rest, [3] or [point, 3] [m].")
      .def("pull_back", &valuesAt<&motion::MotionMap::pullBack>, py::arg("points"),
           "Places at rest of points in the moved patient, e.g. of tips and nodes, [3] or [point, 3] [m].")
      .def("velocity", &valuesAt<&motion::MotionMap::velocity>, py::arg("points"),
           "Velocities of points of the patient, given by their places at rest, [3] or [point, 3] [m/s].")
      .def("__repr__", &represented);
}

void bindMotion(py::class_<OwnedSession, std::shared_ptr<OwnedSession>>& session)
{
  session
      .def_property_readonly(
          "motion",
          [](OwnedSession& self)
          {
            const OwnedSession::Use used(self);
            return motionOf(used->observe());
          },
          "Motion of the patient, a copy; None without the key motion.")
      .def("set_motion", &setMotion, py::arg("heart_rate") = py::none(), py::arg("breathing_rate") = py::none(),
           py::arg("breath_held") = py::none(), R"(
Changes the patient's motion; what is not given stays.

heart_rate      from the next beat on: 0.333 to 5 [Hz]; with the key flow, set_flow() sets it
breathing_rate  from the next breath on: 0.03 to 1 [Hz]
breath_held     True: the breath is held from the next end of an expiration on; False: it goes on

Raises InputError for other values, and UsageError in a scene without the key motion.)");
}

}  // namespace endovascular_sim::python
