#pragma once

#include <pybind11/pybind11.h>

#include "session/observation.h"

namespace endovascular_sim::python
{

/** Observation as Python sees it: copies of the parts of session::Observation, valid for ever. */
pybind11::object snapshotOf(const session::Observation& observation, double time_step);

/** Position of an instrument's tip in the branches, as endovascular_sim.Branch. */
pybind11::object branchOf(const session::Observation& observation, int instrument);

void bindObservation(pybind11::module_& module);

}  // namespace endovascular_sim::python
