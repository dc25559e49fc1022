#include "world.h"

#include <algorithm>
#include <array>
#include <optional>

#include <Eigen/Geometry>

#include <pybind11/stl.h>

#include "arrays.h"
#include "common/error.h"
#include "common/hash.h"
#include "fluoroscopy/gantry/view.h"
#include "fluoroscopy/projection/x_ray_geometry.h"
#include "overrides.h"
#include "scene/scene_file.h"
#include "signals.h"
#include "simulation/simulation.h"
#include "vessel/centreline/centreline_extraction.h"

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

/** World with a centreline of its vessel, extracted where it has none. It shares the wall of the given one. */
std::shared_ptr<const session::World> withCentreline(std::shared_ptr<const session::World> world)
{
  if (world->vessel() == nullptr || !world->vessel()->centreline.branches.empty())
    return world;
  auto vessel = std::make_shared<vessel::Vessel>(*world->vessel());
  vessel->centreline = vessel::extractCentreline(vessel->mesh, interruptible());
  return session::World::make(world->scene(), std::move(vessel), world->wall(), world->entry());
}

WorldPointer openWorld(const py::object& scene, bool centreline, const py::kwargs& keywords)
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
    if (centreline)
      world = withCentreline(std::move(world));
  }
  warn(*world);
  return std::make_shared<SharedWorld>(std::move(world), centreline);
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
          : session::World::parse(present.resolved_yaml, present.file, overrides),
      shared.hasCentreline());
}

/** Function and arguments that make an equal world in any process: text and origin of the scene. py::pickle would end
 *  the process for protocols below 2. */
py::tuple reduced(const SharedWorld& shared)
{
  return py::make_tuple(py::module_::import("endovascular_sim._pickles").attr("world"),
                        py::make_tuple(shared.scene().resolved_yaml, shared.scene().file, shared.hasCentreline()));
}

WorldPointer unpickled(const std::string& yaml, const std::string& file, bool centreline)
{
  const py::gil_scoped_release released;
  std::shared_ptr<const session::World> world = session::World::parse(yaml, file, {}, interruptible());
  return std::make_shared<SharedWorld>(centreline ? withCentreline(std::move(world)) : std::move(world), centreline);
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

/** Largest outer radius of each instrument [m]. */
py::array_t<double> instrumentRadii(const scene::Scene& scene)
{
  py::array_t<double> radii(static_cast<py::ssize_t>(scene.instruments.size()));
  for (std::size_t k = 0; k < scene.instruments.size(); ++k)
  {
    double& radius = radii.mutable_at(static_cast<py::ssize_t>(k)) = 0.0;
    for (const rod::Section& section : scene.instruments[k].instrument.wire.sections)
      radius = std::max(radius, section.radius);
  }
  return radii;
}

/** Pose of the C-arm for a view.
 *  @param isocentre empty: that of the scene, else the centre of the vessel's bounding box */
fluoroscopy::CArmPose poseOf(const session::World& world, const std::string& view,
                             const std::optional<std::array<double, 3>>& isocentre)
{
  const scene::Scene& scene = world.scene();
  if (!scene.fluoroscopy)
    throw InputError(scene.file, "fluoroscopy", "missing; add `fluoroscopy: {}` for a camera");
  fluoroscopy::CArmPose pose = scene.fluoroscopy->pose();
  if (!view.empty())
  {
    const std::optional<fluoroscopy::View> angles = fluoroscopy::parseView(view);
    if (!angles)
      throw InputError("camera", "view", fluoroscopy::unknownView(view));
    pose.primary_angle = angles->primary_angle;
    pose.secondary_angle = angles->secondary_angle;
  }
  if (isocentre)
    pose.isocentre = Eigen::Map<const Eigen::Vector3d>(isocentre->data());
  else if (!scene.fluoroscopy->isocentre && world.vessel() != nullptr)
  {
    Eigen::AlignedBox3d box;
    for (const Eigen::Vector3d& vertex : world.vessel()->mesh.vertices)
      box.extend(vertex);
    pose.isocentre = box.center();
  }
  return pose;
}

/** Camera matrix [3, 4]: patient frame [m] to column and row [pixel], homogeneous. */
py::array_t<double> cameraOf(const SharedWorld& shared, const std::string& view,
                             const std::optional<std::array<double, 3>>& isocentre)
{
  const fluoroscopy::XRayGeometry geometry(poseOf(shared.world(), view, isocentre));
  Eigen::Matrix<double, 3, 4, Eigen::RowMajor> matrix;
  matrix.leftCols<3>() = geometry.cameraMatrix() * geometry.axes().transpose();
  matrix.col(3) = -matrix.leftCols<3>() * geometry.source();
  return py::array_t<double>({3, 4}, matrix.data());
}

/** Branches of the centreline: per branch name, parent, points [point, 3], radii [point] and ostium. */
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
    entry["ostium"] = branch.points.empty() ? 0.0 : -world.branches()->depthIn(index - 1, branch.points.front());
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
    for (const drive::HandCommand& command :
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

World(scene, *, centreline=False, **overrides)

scene      name of a bundled scene, e.g. "tube"; path of a YAML file; or the text of a scene
overrides  values of keys of the scene (docs/SCENES.md), as `simulate --set`; a dictionary stands for the keys
           below its own: World("tube", duration=2, drive={"speed": 0.02}, **{"vessel.friction": 0.2})
centreline True: extracts the branches of a large mesh, too, which takes seconds; environments need them

Any number of sessions share a world, also in different threads. A world can be copied and pickled; a pickle holds the
text of the scene, and names the files of its vessel.
Raises InputError when the scene or its vessel is refused. Warnings of the scene are UserWarning.)")
      .def(py::init(&openWorld), py::arg("scene").none(false), py::kw_only(), py::arg("centreline") = false)
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
          "radii", [](const SharedWorld& self) { return instrumentRadii(self.scene()); },
          "Largest outer radii of the instruments [m], [instrument]; a copy.")
      .def("camera", &cameraOf, py::arg("view") = "", py::arg("isocentre") = py::none(), R"(
Camera matrix of a pose of the C-arm, [3, 4]: point [m] in the patient frame to (column w, row w, w) [pixel] of the image.
view       in clinical notation; empty: that of the scene
isocentre  [3] [m]; None: that of the scene, else the centre of the vessel's bounding box
Raises InputError for a scene without fluoroscopy, and for an unknown view.)")
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
          "[m], [point, 3]; radii [m], [point]; ostium, length along the points at which the branch leaves the lumen "
          "of "
          "its parent [m]. Empty for a large mesh without centreline=True.")
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
