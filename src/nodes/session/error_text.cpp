#include "nodes/session/error_text.h"

#include <algorithm>

#include "common/text/format.h"

namespace endovascular_sim::nodes
{

std::string textOf(const results::SessionError& error, const scene::Scene& scene)
{
  std::string text = error.kind + ": " + scene.instruments[static_cast<std::size_t>(error.instrument)].instrument.name;
  std::replace(text.begin(), text.begin() + static_cast<std::ptrdiff_t>(error.kind.size()), '_', ' ');
  if (error.unit == "m")
    return text + formatted(", %.1f mm", 1e3 * error.value);
  return error.unit.empty() ? text : text + formatted(", %.2f %s", error.value, error.unit.c_str());
}

}  // namespace endovascular_sim::nodes
