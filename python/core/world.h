#pragma once

#include <memory>
#include <string>
#include <vector>

#include <pybind11/pybind11.h>

#include "errors.h"
#include "session/world.h"
#include "zeroed.h"

namespace endovascular_sim::python
{

/** World as Python sees it. It never changes, and threads may use it at the same time. */
class SharedWorld : public Zeroed
{
public:
  /** @param world not null */
  explicit SharedWorld(std::shared_ptr<const session::World> world) : world_(std::move(world)) {}

  /** @throws UsageError for an object that Python made without its constructor */
  const std::shared_ptr<const session::World>& pointer() const
  {
    if (!world_)
      throw UsageError("the world was not made by its constructor");
    return world_;
  }

  const session::World& world() const { return *pointer(); }
  const scene::Scene& scene() const { return world().scene(); }

private:
  std::shared_ptr<const session::World> world_;
};

/** Index of an instrument of a scene.
 *  @param instrument index, also from the end with negative numbers, or name
 *  @throws InputError if the scene has no such instrument */
int instrumentIndex(const scene::Scene& scene, const pybind11::object& instrument);

void bindWorld(pybind11::module_& module);

}  // namespace endovascular_sim::python
