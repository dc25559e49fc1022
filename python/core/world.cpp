#include "world.h"

#include <algorithm>

#include <pybind11/stl.h>

#include "arrays.h"
#include "common/error.h"
#include "common/hash.h"
#include "overrides.h"
#include "scene/scene_file.h"
#include "signals.h"
#include "simulation/simulation.h"

namespace endovascular_sim::python
{
namespace py = pybind11;
namespace
{

using WorldPointer = std::shared_ptr<SharedWorld>;

/** Keys of the vessel that World::with() can change: vessel and wall stay the same. */
const std::vector<std::string> kLawOfWall = {"vessel.friction", "vessel.stiffness", "vessel.friction_regions"};

/** A text of several lines, or with a colon and a space, is a scene; other texts are files or names. */
bool isSceneText(const std::string& text)
{
  return text.find('\n') != std::string::npos || text.find(": ") != std::string::npos;
}

/** Progress that handles pending signals, so that Ctrl-C ends the preparation of a large mesh. */
ProgressReport interruptible()
{
  return [check = SignalCheck()](const char*, double) mutable { check(); };
}

/** Passes the warnings of scene and vessel to Python. */
void warn(const session::World& world)
{
  std::vector<std::string> texts = world.scene().warnings;
  if (world.vessel() != nullptr)
    texts.insert(texts.end(), world.vessel()->warnings.begin(), world.vessel()->warnings.end());
  for (const std::string& text : texts)
    if (PyErr_WarnEx(PyExc_UserWarning, text.c_str(), 1) != 0)
      throw py::error_already_set();
}

WorldPointer openWorld(const py::object& scene, const py::kwargs& keywords)
{
  const bool is_path = py::hasattr(scene, "__fspath__");
  if (!is_path && !py::isinstance<py::str>(scene))
    throw InputError("World", "", "needs a scene: the name of a bundled one, a file, or the text of a scene");
  const std::string text =
      is_path ? py::str(scene.attr("__fspath__")()).cast<std::string>() : scene.cast<std::string>();
  const std::vector<std::string> overrides = overridesFrom(keywords);
  std::shared_ptr<const session::World> world;
  {
    const py::gil_scoped_release released;
    world = !is_path && isSceneText(text) ? session::World::parse(text, "scene", overrides, interruptible())
                                          : session::World::open(text, overrides, interruptible());
  }
  warn(*world);
  return std::make_shared<SharedWorld>(std::move(world));
}

bool keepsVessel(const std::string& override_text)
{
  const std::string key = override_text.substr(0, override_text.find('='));
  const auto begins = [&key](const std::string& with) { return key == with || key.rfind(with + ".", 0) == 0; };
  if (begins("vessel"))
    return std::any_of(kLawOfWall.begin(), kLawOfWall.end(), begins);
  return !begins("entry") && !begins("fluoroscopy.patient");
}

WorldPointer varyWorld(const SharedWorld& shared, const py::kwargs& keywords)
{
  const std::vector<std::string> overrides = overridesFrom(keywords);
  for (const std::string& text : overrides)
    if (!keepsVessel(text))
      throw InputError("vary", text, "changes what both worlds share: vessel, entry or patient; open another World");
  const py::gil_scoped_release released;
  const scene::Scene& present = shared.scene();
  return std::make_shared<SharedWorld>(
      shared.world().vessel() != nullptr
          ? shared.world().with(scene::parseScene(present.resolved_yaml, present.file, overrides))
          : session::World::parse(present.resolved_yaml, present.file, overrides));
}

/** Function and arguments that make an equal world in any process: text and origin of the scene. py::pickle would end
 *  the process for protocols below 2. */
py::tuple reduced(const SharedWorld& shared)
{
  return py::make_tuple(py::module_::import("endovascular_sim._pickles").attr("world"),
                        py::make_tuple(shared.scene().resolved_yaml, shared.scene().file));
}

WorldPointer unpickled(const std::string& yaml, const std::string& file)
{
  const py::gil_scoped_release released;
  return std::make_shared<SharedWorld>(session::World::parse(yaml, file, {}, interruptible()));
}

py::tuple instrumentNames(const scene::Scene& scene)
{
  py::tuple names(scene.instruments.size());
  for (std::size_t k = 0; k < names.size(); ++k)
    names[k] = scene.instruments[k].instrument.name;
  return names;
}

py::array_t<double> instrumentLengths(const scene::Scene& scene)
{
  py::array_t<double> lengths(static_cast<py::ssize_t>(scene.instruments.size()));
  for (std::size_t k = 0; k < scene.instruments.size(); ++k)
    lengths.mutable_at(static_cast<py::ssize_t>(k)) = scene.instruments[k].instrument.wire.length();
  return lengths;
}

/** Branches of the centreline: per branch name, parent, points [point, 3] and radii [point]. */
py::list branchesOf(const session::World& world)
{
  py::list branches;
  if (world.vessel() == nullptr)
    return branches;
  int index = 0;
  for (const vessel::CentrelineBranch& branch : world.vessel()->centreline.branches)
  {
    py::dict entry;
    entry["name"] = world.branches()->name(index++);
    entry["parent"] = branch.parent;
    entry["points"] = pointArray(branch.points);
    entry["radii"] = py::array_t<double>(static_cast<py::ssize_t>(branch.radii.size()), branch.radii.data());
    branches.append(entry);
  }
  return branches;
}

const vessel::Vessel& vesselOf(const SharedWorld& shared)
{
  static const vessel::Vessel none;
  return shared.world().vessel() != nullptr ? *shared.world().vessel() : none;
}

/** Commands of the scene's drives for steps after the first ones, [step, instrument, 3]. */
py::array_t<double> commandsOf(const SharedWorld& shared, std::int64_t steps, std::int64_t first)
{
  if (steps < 0 || first < 0)
    throw InputError("commands", "", "needs a number of steps and a first step of 0 or more");
  const auto instruments = static_cast<py::ssize_t>(shared.scene().instruments.size());
  py::array_t<double> array({static_cast<py::ssize_t>(steps), instruments, py::ssize_t{3}});
  double* value = array.mutable_data();
  for (std::int64_t k = first + 1; k <= first + steps; ++k)
    for (const simulation::HandCommand& command :
         simulation::commandsAt(shared.scene(), static_cast<double>(k) * shared.scene().solver.time_step))
    {
      *value++ = command.insertion;
      *value++ = command.rotation;
      *value++ = command.pressure;
    }
  return array;
}

std::string represented(const SharedWorld& shared)
{
  const std::size_t triangles = vesselOf(shared).mesh.triangles.size();
  return "<World '" + shared.scene().name + "', " + std::to_string(shared.scene().instruments.size()) +
         " instruments, " + std::to_string(triangles) + " triangles>";
}

}  // namespace

int instrumentIndex(const scene::Scene& scene, const py::object& instrument)
{
  const int count = static_cast<int>(scene.instruments.size());
  if (py::isinstance<py::str>(instrument))
  {
    const auto name = instrument.cast<std::string>();
    for (int k = 0; k < count; ++k)
      if (scene.instruments[static_cast<std::size_t>(k)].instrument.name == name)
        return k;
  }
  else if (PyIndex_Check(instrument.ptr()) != 0)
  {
    const Py_ssize_t index = PyNumber_AsSsize_t(instrument.ptr(), nullptr);
    if (index >= -count && index < count)
      return static_cast<int>(index < 0 ? index + count : index);
  }
  throw InputError(
      "instrument", py::repr(instrument).cast<std::string>(),
      "is none of " + py::repr(instrumentNames(scene)).cast<std::string>() + "; give a name or an index from 0");
}

void bindWorld(py::module_& module)
{
  py::class_<SharedWorld, WorldPointer>(module, "World", R"(
Scene with all that follows from it and never changes: vessel, prepared wall, branches, patient of the X-ray image.

World(scene, **overrides)

scene      name of a bundled scene, e.g. "tube"; path of a YAML file; or the text of a scene
overrides  values of keys of the scene (docs/SCENES.md), as `simulate --set`; a dictionary stands for the keys
           below its own: World("tube", duration=2, drive={"speed": 0.02}, **{"vessel.friction": 0.2})

Any number of sessions share a world, also in different threads. A world can be copied and pickled; a pickle holds the
text of the scene, and names the files of its vessel.
Raises InputError when the scene or its vessel is refused. Warnings of the scene are UserWarning.)")
      .def(py::init(&openWorld), py::arg("scene").none(false))
      .def("vary", &varyWorld, R"(
World of the same vessel with other values, e.g. vary(**{"vessel.friction": 0.2}). Both share vessel and wall, so that
it costs milliseconds and little memory. Raises InputError for a key of the vessel's shape, the entry or the patient.)")
      .def_property_readonly(
          "name", [](const SharedWorld& self) { return self.scene().name; }, "Name of the scene.")
      .def_property_readonly(
          "yaml", [](const SharedWorld& self) { return self.scene().resolved_yaml; },
          "Complete text of the scene, with overrides and included files.")
      .def_property_readonly(
          "hash", [](const SharedWorld& self) { return Hash64::toHex(self.scene().hash()); },
          "Hash of `yaml`, 16 hexadecimal digits.")
      .def_property_readonly(
          "mesh_hash", [](const SharedWorld& self) { return Hash64::toHex(self.world().meshHash()); },
          "Hash of the mesh, 16 hexadecimal digits; zeros without a vessel.")
      .def_property_readonly(
          "time_step", [](const SharedWorld& self) { return self.scene().solver.time_step; }, "Duration of a step [s].")
      .def_property_readonly(
          "duration", [](const SharedWorld& self) { return self.scene().duration; }, "Simulated time of the scene [s].")
      .def_property_readonly(
          "instruments", [](const SharedWorld& self) { return instrumentNames(self.scene()); },
          "Names of the instruments, from the inside out.")
      .def_property_readonly(
          "lengths", [](const SharedWorld& self) { return instrumentLengths(self.scene()); },
          "Lengths of the instruments [m], [instrument]; a copy.")
      .def_property_readonly(
          "entry",
          [](const SharedWorld& self) {
            return py::make_tuple(vectorArray(self.world().entry().position),
                                  vectorArray(self.world().entry().direction));
          },
          "Position [m] and direction of the introducer in the patient frame, two [3].")
      .def_property_readonly(
          "vertices", [](const SharedWorld& self) { return pointArray(vesselOf(self).mesh.vertices); },
          "Vertices of the undeformed wall in the patient frame [m], [vertex, 3]; a copy.")
      .def_property_readonly(
          "triangles", [](const SharedWorld& self) { return triangleArray(vesselOf(self).mesh); },
          "Indices of the vertices of each triangle of the wall, [triangle, 3]; a copy.")
      .def_property_readonly(
          "branches", [](const SharedWorld& self) { return branchesOf(self.world()); },
          "Branches of the centreline, a list of dictionaries: name; parent, index or -1; points "
          "[m], [point, 3]; radii [m], [point]. Empty where the scene needs no centreline.")
      .def_property_readonly(
          "notes", [](const SharedWorld& self) { return vesselOf(self).notes; },
          "Repairs and modifications of the vessel's mesh, as texts.")
      .def("commands", &commandsOf, py::arg("steps"), py::arg("first") = 0, R"(
Commands of the scene's drives, [steps, instrument, 3], as for Session.step(): those of the steps after step `first`.)")
      .def("__copy__", [](const WorldPointer& self) { return self; })
      .def("__deepcopy__", [](const WorldPointer& self, const py::object&) { return self; })
      .def("__repr__", &represented)
      .def("__reduce__", &reduced);
  module.def("_world_of_pickle", &unpickled);
}

}  // namespace endovascular_sim::python
