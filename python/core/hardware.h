#pragma once

#include <pybind11/pybind11.h>

#include "session.h"

namespace endovascular_sim::python
{

/** Readings of all sensors by their names, a dictionary of endovascular_sim.Reading. */
pybind11::dict readingsOf(const session::Observation& observation, double time_step);

void bindReading(pybind11::module_& module);

/** Sensors and faults of a session. */
void bindHardware(pybind11::class_<OwnedSession, std::shared_ptr<OwnedSession>>& bound);

}  // namespace endovascular_sim::python
