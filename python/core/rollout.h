#pragma once

#include <pybind11/pybind11.h>

namespace endovascular_sim::python
{

/** Functions that step several sessions at a time: rollout() and advance(). */
void bindRollout(pybind11::module_& module);

}  // namespace endovascular_sim::python
