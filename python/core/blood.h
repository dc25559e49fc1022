#pragma once

#include <pybind11/pybind11.h>

#include "session.h"
#include "session/observation.h"

namespace endovascular_sim::python
{

/** Pressure and flow of the blood as endovascular_sim.Blood, a copy; None in a scene without the key `flow`, and before
 *  the first step of the flow. */
pybind11::object bloodOf(const session::Observation& observation);

void bindBlood(pybind11::module_& module);

/** Adds what belongs to the flow of blood to the class of the sessions. */
void bindBlood(pybind11::class_<OwnedSession, std::shared_ptr<OwnedSession>>& session);

}  // namespace endovascular_sim::python
