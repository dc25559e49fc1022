#include "contrast.h"

#include <limits>
#include <optional>
#include <string>

#include <pybind11/numpy.h>
#include <pybind11/stl.h>

#include "common/error.h"
#include "common/text/format.h"
#include "errors.h"
#include "zeroed.h"

namespace endovascular_sim::python
{
namespace py = pybind11;
namespace
{

/** Contrast medium after a step, valid for ever. */
struct Contrast : Zeroed
{
  py::array_t<double> cells, instruments;
  double rate, remaining, syringe, volume, injected, inside, left;
};

/** Values of a vector, or zeros where it is empty. */
py::array_t<double> arrayOf(const std::vector<double>& values, std::size_t size)
{
  py::array_t<double> array(static_cast<py::ssize_t>(size));
  for (std::size_t k = 0; k < size; ++k)
    array.mutable_at(static_cast<py::ssize_t>(k)) = values.empty() ? 0.0 : values[k];
  return array;
}

std::string represented(const Contrast& contrast)
{
  return formatted("<Contrast, %.2f ml injected, %.2f ml in the syringe>", 1e6 * contrast.volume,
                   1e6 * contrast.syringe);
}

void requireContrast(const session::Session& session)
{
  if (session.simulation().contrast() == nullptr)
    throw UsageError("no contrast medium is injected in this scene; give it the keys contrast and flow");
}

void inject(OwnedSession& owner, double volume, double rate, double rise, const std::optional<double>& concentration,
            bool refill)
{
  const OwnedSession::Use session(owner);
  requireContrast(*session);
  const contrast::Injection injection = session->scene().contrast->injection(
      volume, rate, rise, concentration.value_or(std::numeric_limits<double>::quiet_NaN()));
  if (const std::string refusal = session->refusalOf(injection, refill); !refusal.empty())
    throw InputError("inject", "", refusal);
  session->inject(injection, refill);
}

template <void (session::Session::*function)()>
void call(OwnedSession& owner)
{
  const OwnedSession::Use session(owner);
  requireContrast(*session);
  ((*session).*function)();
}

}  // namespace

py::object contrastOf(const session::Observation& observation)
{
  const std::optional<session::ContrastState> state = observation.contrast();
  if (!state)
    return py::none();
  return py::cast(Contrast{{},
                           arrayOf(state->cells, state->cells.size()),
                           arrayOf(state->instruments, static_cast<std::size_t>(observation.instruments())),
                           state->rate,
                           state->remaining,
                           state->syringe,
                           state->volume,
                           state->iodine.injected,
                           state->iodine.inside,
                           state->iodine.left});
}

void bindContrast(py::module_& module)
{
  py::class_<Contrast>(module, "Contrast", "Contrast medium after a step. The arrays are copies.")
      .def_readonly("cells", &Contrast::cells,
                    "Iodine in each cell of the vessel [kg/m^3], which is mgI/ml; empty while there is none.")
      .def_readonly("instruments", &Contrast::instruments, "Iodine in the lumen of each instrument [kg/m^3].")
      .def_readonly("rate", &Contrast::rate, "Present rate of the injection [m^3/s].")
      .def_readonly("remaining", &Contrast::remaining, "Left of the present injection [m^3].")
      .def_readonly("syringe", &Contrast::syringe, "Left in the syringe [m^3].")
      .def_readonly("volume", &Contrast::volume, "Injected since the beginning of the run [m^3].")
      .def_readonly("injected", &Contrast::injected, "Iodine that has entered the vessel [kg].")
      .def_readonly("inside", &Contrast::inside, "Iodine in the vessel [kg].")
      .def_readonly("left", &Contrast::left, "Iodine that has left the vessel [kg].")
      .def("__repr__", &represented);
}

void bindContrast(py::class_<OwnedSession, std::shared_ptr<OwnedSession>>& session)
{
  session
      .def_property_readonly(
          "contrast",
          [](OwnedSession& self)
          {
            const OwnedSession::Use used(self);
            return contrastOf(used->observe());
          },
          "Contrast medium, a copy; None without the key contrast.")
      .def("inject", &inject, py::arg("volume"), py::arg("rate"), py::arg("rise") = 0.3,
           py::arg("concentration") = py::none(), py::arg("refill") = false, R"(
Begins an injection of contrast medium through the instrument that the scene names, with the next step of the flow.

volume         [m^3], e.g. 6e-6
rate           after its rise [m^3/s], e.g. 4e-6
rise           time in which the rate rises from zero [s]
concentration  iodine of the medium [kg/m^3], which is mgI/ml; None: that of the scene
refill         True: the syringe is filled before

Raises InputError for an impossible injection, more than the syringe holds, during another injection, and with no opening
of the instrument in the vessel; UsageError in a scene without the key contrast. Such a call changes nothing.)")
      .def("stop_injection", &call<&session::Session::stopInjection>,
           "Ends the present injection; the rest stays in the syringe.")
      .def("refill_syringe", &call<&session::Session::refillSyringe>,
           "Ends the present injection, and fills the syringe.");
}

}  // namespace endovascular_sim::python
