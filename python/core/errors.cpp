#include "errors.h"

#include <utility>

#include "common/error.h"

namespace endovascular_sim::python
{
namespace py = pybind11;
namespace
{

/** Classes for the translator, which has no other state. They live as long as the interpreter. */
PyObject* input_error = nullptr;
PyObject* usage_error = nullptr;

PyObject* newClass(py::module_& module, const char* name, const char* documentation, const py::tuple& bases)
{
  const std::string full_name = std::string("endovascular_sim.") + name;
  PyObject* made = PyErr_NewExceptionWithDoc(full_name.c_str(), documentation, bases.ptr(), nullptr);
  if (made == nullptr)
    throw py::error_already_set();
  module.add_object(name, py::reinterpret_borrow<py::object>(made));
  return made;
}

void translate(std::exception_ptr thrown)
{
  try
  {
    std::rethrow_exception(std::move(thrown));
  }
  catch (const InputError& error)
  {
    PyErr_SetString(input_error, error.what());
  }
  catch (const std::invalid_argument& error)
  {
    PyErr_SetString(input_error, error.what());
  }
  catch (const std::logic_error& error)
  {
    PyErr_SetString(usage_error, error.what());
  }
}

}  // namespace

void bindErrors(py::module_& module)
{
  const auto base = [](PyObject* exception) { return py::reinterpret_borrow<py::object>(exception); };
  PyObject* error =
      newClass(module, "Error", "Base of all exceptions of this package.", py::make_tuple(base(PyExc_Exception)));
  input_error = newClass(module, "InputError",
                         "Refused input: a scene, a state, a file or an argument. The text names the key and the "
                         "remedy.",
                         py::make_tuple(base(error), base(PyExc_ValueError)));
  usage_error = newClass(module, "UsageError",
                         "Wrong use of an object, e.g. after close() or in two threads at once. It changes nothing.",
                         py::make_tuple(base(error), base(PyExc_RuntimeError)));
  py::register_local_exception_translator(translate);
}

}  // namespace endovascular_sim::python
