#pragma once

#include <string>
#include <vector>

#include <pybind11/pybind11.h>

namespace endovascular_sim::python
{

/** Texts `key.path=value` of keyword arguments, in their order. A dictionary stands for the keys below its own.
 *  @throws InputError for a value that no scene holds, e.g. a function */
std::vector<std::string> overridesFrom(const pybind11::dict& keywords);

}  // namespace endovascular_sim::python
