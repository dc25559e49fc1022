#include "signals.h"

#include <pybind11/pybind11.h>

namespace endovascular_sim::python
{

void SignalCheck::handleSignals()
{
  const pybind11::gil_scoped_acquire locked;
  if (PyErr_CheckSignals() != 0)
    throw pybind11::error_already_set();
}

}  // namespace endovascular_sim::python
