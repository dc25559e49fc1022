#pragma once

#include <memory>

#include <pybind11/pybind11.h>

#include "session.h"

namespace endovascular_sim::python
{

/** Binds runs of X-ray frames. */
void bindCine(pybind11::module_& module, pybind11::class_<OwnedSession, std::shared_ptr<OwnedSession>>& session);

}  // namespace endovascular_sim::python
