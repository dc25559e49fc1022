#pragma once

#include <pybind11/pybind11.h>

#include "session.h"
#include "session/observation.h"

namespace endovascular_sim::python
{

/** Motion of the patient as endovascular_sim.Motion, a copy; None in a scene without the key `motion`. */
pybind11::object motionOf(const session::Observation& observation);

void bindMotion(pybind11::module_& module);

/** Adds what belongs to the motion of the patient to the class of the sessions. */
void bindMotion(pybind11::class_<OwnedSession, std::shared_ptr<OwnedSession>>& session);

}  // namespace endovascular_sim::python
