#include "overrides.h"

#include <cmath>

#include "common/error.h"

namespace endovascular_sim::python
{
namespace py = pybind11;
namespace
{

std::string yamlOf(const py::handle& value, const std::string& key);

std::string flowList(const py::handle& values, const std::string& key)
{
  std::string text;
  for (const py::handle item : values)
    text += (text.empty() ? "" : ", ") + yamlOf(item, key);
  return "[" + text + "]";
}

std::string flowMap(const py::dict& map, const std::string& key)
{
  std::string text;
  for (const auto& [name, value] : map)
    text += (text.empty() ? "" : ", ") + py::str(name).cast<std::string>() + ": " + yamlOf(value, key);
  return "{" + text + "}";
}

std::string numberText(double value)
{
  if (std::isnan(value))
    return ".nan";
  if (std::isinf(value))
    return value > 0.0 ? ".inf" : "-.inf";
  return py::repr(py::float_(value)).cast<std::string>();
}

std::string yamlOf(const py::handle& value, const std::string& key)
{
  if (value.is_none())
    return "none";
  if (py::isinstance<py::bool_>(value))
    return value.cast<bool>() ? "true" : "false";
  if (py::isinstance<py::float_>(value))
    return numberText(value.cast<double>());
  if (py::isinstance<py::int_>(value) || py::isinstance<py::str>(value) || py::hasattr(value, "__fspath__"))
    return py::str(value).cast<std::string>();
  if (py::isinstance<py::list>(value) || py::isinstance<py::tuple>(value))
    return flowList(value, key);
  if (py::isinstance<py::dict>(value))
    return flowMap(py::reinterpret_borrow<py::dict>(value), key);
  if (py::hasattr(value, "tolist"))  // arrays and scalars of numpy
    return yamlOf(value.attr("tolist")(), key);
  throw InputError("overrides", key,
                   "is a " + py::str(py::type::of(value).attr("__name__")).cast<std::string>() +
                       "; give a number, text, list, dictionary, or None to remove a part");
}

void append(const py::dict& keywords, const std::string& prefix, std::vector<std::string>& texts)
{
  for (const auto& [name, value] : keywords)
  {
    const std::string key = prefix + py::str(name).cast<std::string>();
    if (py::isinstance<py::dict>(value) && py::len(value) > 0)
      append(py::reinterpret_borrow<py::dict>(value), key + ".", texts);
    else
      texts.push_back(key + "=" + yamlOf(value, key));
  }
}

}  // namespace

std::vector<std::string> overridesFrom(const py::dict& keywords)
{
  std::vector<std::string> texts;
  append(keywords, "", texts);
  return texts;
}

}  // namespace endovascular_sim::python
