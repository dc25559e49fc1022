#pragma once

#include <pybind11/pybind11.h>

#include "session.h"
#include "session/observation.h"

namespace endovascular_sim::python
{

/** Contrast medium as endovascular_sim.Contrast, a copy; None in a scene without the key `contrast`. */
pybind11::object contrastOf(const session::Observation& observation);

void bindContrast(pybind11::module_& module);

/** Adds what belongs to contrast medium to the class of the sessions. */
void bindContrast(pybind11::class_<OwnedSession, std::shared_ptr<OwnedSession>>& session);

}  // namespace endovascular_sim::python
