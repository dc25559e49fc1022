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
  /** @param world not null
   *  @param has_centreline true for a world that was asked for a centreline */
  SharedWorld(std::shared_ptr<const session::World> world, bool has_centreline)
    : world_(std::move(world)), has_centreline_(has_centreline)
  {
  }

  bool hasCentreline() const { return has_centreline_; }

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
  bool has_centreline_;
};

/** Index of an instrument of a scene.
 *  @param instrument index, also from the end with negative numbers, or name
 *  @throws InputError if the scene has no such instrument */
int instrumentIndex(const scene::Scene& scene, const pybind11::object& instrument);

void bindWorld(pybind11::module_& module);

}  // namespace endovascular_sim::python
