#pragma once

#include <stdexcept>

#include <pybind11/pybind11.h>

namespace endovascular_sim::python
{

/** Wrong use of an object: after its end, or in two threads at once. Python sees it as endovascular_sim.UsageError. */
class UsageError : public std::logic_error
{
public:
  using std::logic_error::logic_error;
};

/** Adds the exception classes Error, InputError (also a ValueError) and UsageError (also a RuntimeError) to the module.
 *  InputError of the core and std::invalid_argument become InputError, other std::logic_error become UsageError. */
void bindErrors(pybind11::module_& module);

}  // namespace endovascular_sim::python
