#include "session.h"

#include <algorithm>

#include <pybind11/stl.h>

#include "arrays.h"
#include "blood.h"
#include "cine.h"
#include "common/error.h"
#include "common/hash.h"
#include "contrast.h"
#include "errors.h"
#include "hardware.h"
#include "observation.h"
#include "patient_motion.h"
#include "signals.h"
#include "simulation/instrument_tip.h"

namespace endovascular_sim::python
{
namespace py = pybind11;
namespace
{

using SessionPointer = std::shared_ptr<OwnedSession>;
using Use = OwnedSession::Use;

constexpr auto kClient = "python";  // name of this client in the controls of instruments

/** Result of a function of the session and, without its use, of its observation. @{ */
template <typename Function>
auto read(OwnedSession& owner, const Function& function)
{
  const Use session(owner);
  return function(*session);
}

template <typename Function>
auto seen(OwnedSession& owner, const Function& function)
{
  const Use session(owner);
  return function(session->observe());
}
/** @} */

// -------------------------------------------------------------------------------------------------------- stepping

/** Steps by the scene's drives, the operator and clients. @return number of steps made */
std::int64_t stepByDrives(session::Session& session, std::int64_t steps)
{
  const py::gil_scoped_release released;
  SignalCheck handle_signals;
  std::int64_t made = 0;
  for (; made < steps && session.step() > 0; ++made)
    handle_signals();
  return made;
}

std::int64_t stepByCommands(session::Session& session, const std::vector<StepCommands>& commands, std::int64_t steps)
{
  const py::gil_scoped_release released;
  SignalCheck handle_signals;
  for (std::int64_t k = 0; k < steps; ++k)
  {
    session.step(commands[std::min(static_cast<std::size_t>(k), commands.size() - 1)]);
    handle_signals();
  }
  return steps;
}

std::int64_t step(OwnedSession& owner, const py::object& commands, const std::optional<std::int64_t>& n)
{
  const Use session(owner);
  if (n && *n < 0)
    throw InputError("n", std::to_string(*n), "is below 0; give a number of steps");
  if (commands.is_none())
    return stepByDrives(*session, n.value_or(1));
  const CommandArray array = commandArray(commands);
  const std::vector<StepCommands> steps = commandsFrom(array, session->scene());
  if (array.ndim() == 2)
    return stepByCommands(*session, steps, n.value_or(1));
  const auto count = static_cast<std::int64_t>(steps.size());
  if (n && *n != count)
    throw InputError("n", std::to_string(*n), "is not the number of commands, " + std::to_string(count));
  return stepByCommands(*session, steps, count);
}

void requireResults(const OwnedSession& owner)
{
  if (!owner.gathersResults())
    throw UsageError("the session gathers no results; make it with results=True");
}

/** Gives a command to the control of an instrument that clients drive. */
void command(OwnedSession& owner, const py::object& instrument, const std::string& name,
             const std::vector<double>& values)
{
  if (!owner.hasClients())
    throw UsageError("the session takes no commands of clients; make it with clients=True");
  const Use session(owner);
  drive::HandControl& control = session->control(instrumentIndex(session->scene(), instrument));
  bool accepted = false;
  if (drive::isStateCommand(name))
    accepted = control.stateCommand(kClient, name);
  else if (const std::optional<drive::CommandKind> kind = drive::commandKind(name))
    accepted = control.command(kClient, drive::jointCommand(*kind, {}, values)) == drive::CommandVerdict::kAccepted;
  else
    throw InputError("command", name, "is unknown; use servo_jp, servo_jr, servo_jv, servo_jf, move_jp or move_jr");
  if (!accepted)
    throw InputError("command", name, "was refused: " + control.arbiter().lastRefusal());
}

// ------------------------------------------------------------------------------------------------------- observing

/** Points of an instrument's centreline from the tip backwards, [count, 3]; the introducer where they would be outside.
 *  @param spacing distance along the centreline [m] */
py::array_t<double> track(OwnedSession& owner, int count, double spacing, const py::object& instrument)
{
  const Use session(owner);
  if (count < 0 || !(spacing >= 0.0))
    throw InputError("track", "", "needs a count and a spacing of 0 or more");
  const session::Observation& observation = session->observe();
  const double insertion = observation.hand(instrumentIndex(session->scene(), instrument)).insertion;
  std::vector<Eigen::Vector3d> points;
  for (int k = 0; k < count; ++k)
    points.push_back(simulation::pointAt(session->simulation(), std::max(0.0, insertion - k * spacing)));
  return pointArray(points);
}

template <typename Pixel>
py::array imageArray(int pixels, const std::vector<Pixel>& values)
{
  return py::array_t<Pixel>({pixels, pixels}, values.data());
}

py::array image(OwnedSession& owner, const std::string& view, bool raw)
{
  const Use session(owner);
  const fluoroscopy::Frame* frame = nullptr;
  {
    const py::gil_scoped_release released;
    frame = &session->image(view);
  }
  return raw ? imageArray(frame->pixels, frame->raw) : imageArray(frame->pixels, frame->image);
}

py::array_t<double> reachedOf(const session::Session& session)
{
  py::array_t<double> rows({session.observe().instruments(), 2});
  for (int k = 0; k < session.observe().instruments(); ++k)
  {
    const drive::HandMotion reached = session.reached(k);
    rows.mutable_at(k, 0) = reached.insertion;
    rows.mutable_at(k, 1) = reached.rotation;
  }
  return rows;
}

py::array_t<double> stopsOf(const session::Session& session)
{
  py::array_t<double> rows({session.observe().instruments(), 2});
  for (int k = 0; k < session.observe().instruments(); ++k)
  {
    const drive::Interval stops = session.stops(k);
    rows.mutable_at(k, 0) = stops.low;
    rows.mutable_at(k, 1) = stops.high;
  }
  return rows;
}

py::object procedureOf(const session::Session& session)
{
  const procedure::Operator* scripted = session.scriptedOperator();
  if (scripted == nullptr)
    return py::none();
  switch (scripted->progress())
  {
    case procedure::Progress::kDone:
      return py::str("done");
    case procedure::Progress::kFailed:
      return py::str("failed: " + scripted->failure());
    default:
      return py::str("running");
  }
}

// ---------------------------------------------------------------------------------------------------------- states

py::bytes save(OwnedSession& owner)
{
  const Use session(owner);
  return session->save();
}

void load(OwnedSession& owner, const std::string& state)
{
  const Use session(owner);
  const py::gil_scoped_release released;
  session->load(state);
}

std::vector<std::string> adopt(OwnedSession& owner, const std::string& state)
{
  const Use session(owner);
  const py::gil_scoped_release released;
  return session->adopt(state);
}

SessionPointer continued(const std::shared_ptr<SharedWorld>& world, bool results, bool clients, std::uint64_t last_step,
                         const std::string& state)
{
  auto made = std::make_shared<OwnedSession>(world, 0, results, clients);
  const Use session(*made);
  session->setLastStep(last_step);
  session->load(state, "pickle");
  return made;
}

/** Function and arguments that make an equal session in any process. */
py::tuple reduced(OwnedSession& owner)
{
  const Use session(owner);
  return py::make_tuple(py::module_::import("endovascular_sim._pickles").attr("session"),
                        py::make_tuple(owner.world(), owner.gathersResults(), owner.hasClients(), session->lastStep(),
                                       py::bytes(session->save())));
}

SessionPointer copied(OwnedSession& owner)
{
  const Use session(owner);
  return continued(owner.world(), owner.gathersResults(), owner.hasClients(), session->lastStep(), session->save());
}

void finish(OwnedSession& owner, const py::object& folder, bool all)
{
  const auto path = py::str(py::module_::import("os").attr("fspath")(folder)).cast<std::string>();
  requireResults(owner);
  const Use session(owner);
  const py::gil_scoped_release released;
  session->finish(path, all ? session::RecordFiles::kAll : session::RecordFiles::kMetrics);
}

std::string represented(OwnedSession& owner)
{
  if (owner.isClosed())
    return "<Session, closed>";
  return read(
      owner, [](const session::Session& session)
      { return "<Session of '" + session.scene().name + "', step " + std::to_string(session.observe().step()) + ">"; });
}

// -------------------------------------------------------------------------------------------------------- bindings

using Class = py::class_<OwnedSession, SessionPointer>;

void bindRun(Class& bound)
{
  bound
      .def("step", &step, py::arg("commands") = py::none(), py::arg("n") = py::none(), R"(
Advances the simulation; the GIL is released meanwhile. Returns the number of steps made.

step()             one step by the scene's drives and operator, and by command()
step(n=100)        as many steps; fewer where the run ends (`over`)
step(commands, n)  commands [instrument, 3], the same in n steps, by default in one
step(commands)     commands [n, instrument, 3], one per step

Commands are positions of the handles: insertion [m], rotation [rad], pressure of the balloon [Pa], each absolute. They
work as those of simulate: the drive's largest speed and the grip limit the motion. Steps by commands go on beyond the
end of the run. Ctrl-C ends the call after a step. Raises InputError for another shape, a number that is not finite, and
a pressure without a balloon; such a call changes nothing.)")
      .def("command", &command, py::arg("instrument"), py::arg("name"), py::arg("values") = std::vector<double>(), R"(
Gives a CRTK command to an instrument whose drive.source is topic or device, in a session with clients=True. The next
step() without commands executes it.

name    servo_jp, servo_jr, servo_jv, servo_jf, move_jp, move_jr, or a state command, e.g. hold, free, disable
values  insertion, rotation and pressure: positions [m, rad, Pa], velocities [m/s, rad/s], or force and torque [N, N m]

Raises InputError with the reason of a refusal.)")
      .def(
          "reset",
          [](OwnedSession& self, std::uint64_t seed)
          {
            const Use session(self);
            const py::gil_scoped_release released;
            session->reset(seed);
          },
          py::arg("seed") = 0, R"(
Returns to the beginning. The session is afterwards, bit for bit, as a new one.
seed  varies start and procedure, as `procedure_study`; 0: the scene as it stands)")
      .def("close", &OwnedSession::close, "Ends the session and frees its memory. A second call has no effect.")
      .def_property_readonly("closed", &OwnedSession::isClosed, "True after close().")
      .def("__enter__", [](const SessionPointer& self) { return self; })
      .def("__exit__", [](OwnedSession& self, const py::args&) { self.close(); })
      .def("__repr__", &represented);
}

void bindObserving(Class& bound)
{
  const auto part = [&bound](const char* name, auto function, const char* documentation)
  {
    bound.def_property_readonly(
        name, [function](OwnedSession& self) { return seen(self, function); }, documentation);
  };
  part("hands", &handsOf,
       "Handles, a structured array [instrument]: insertion [m], rotation [rad], force [N] and "
       "torque [N m] on the hand, pressure [Pa]; a copy.");
  part("tips", &tipsOf,
       "Distal ends, a structured array [instrument]: position [3] in the patient frame [m]; frame "
       "[3, 3], columns tangent, d1, d2 of the material; rotation about the centreline [rad]; a copy.");
  part("forces", &forcesOf,
       "Forces of the wall on the wire, a structured array [touching node]: position [3] on the "
       "wall [m], normal_force [3] and friction_force [3] [N], gap [m], node, triangle; a copy.");
  part("contacts", &contactsOf,
       "Features of the wall near the wire, a structured array: edge, triangle, parameter, "
       "point [3] [m], normal [3], gap [m], clearance_radius [m], stiffness [N/m^2], "
       "friction, id; a copy. Geometry, not force.");
  part(
      "nodes",
      [](const session::Observation& seen)
      { return pointArray(seen.nodes(), static_cast<std::size_t>(seen.firstNode())); },
      "Simulated nodes of the common centreline from the introducer's guide to the tip, [node, 3], patient frame [m]; "
      "a copy. Their number changes with the insertion.");
  part(
      "steps", [](const session::Observation& seen) { return seen.step(); }, "Number of steps so far.");
  part(
      "time", [](const session::Observation& seen) { return seen.time(); }, "Simulated time [s].");
  bound
      .def(
          "observe",
          [](OwnedSession& self)
          {
            const Use session(self);
            return snapshotOf(session->observe(), session->scene().solver.time_step);
          },
          "Observation of the present state; copies of all its parts.")
      .def(
          "branch",
          [](OwnedSession& self, const py::object& instrument)
          {
            const Use session(self);
            return branchOf(session->observe(), instrumentIndex(session->scene(), instrument));
          },
          py::arg("instrument") = 0, "Branch that holds the tip of an instrument, given by its index or name.")
      .def("track", &track, py::arg("count"), py::arg("spacing"), py::arg("instrument") = 0, R"(
Points of an instrument from its tip backwards, [count, 3], patient frame [m]; a copy. Points that would lie outside are
at the introducer.
spacing  distance along the centreline [m])")
      .def("image", &image, py::arg("view") = "", py::arg("raw") = false, R"(
X-ray image of the present state, [pixels, pixels]; a copy. It does not depend on earlier images.
view  in clinical notation, e.g. "LAO 40"; empty: that of the scene
raw   False: display image, uint8; True: detector signal, uint16, linear in intensity
Raises InputError for a scene without fluoroscopy, and for an unknown view.)")
      .def_property_readonly(
          "wall",
          [](OwnedSession& self)
          { return read(self, [](const session::Session& session) { return pointArray(session.wall().vertices); }); },
          "Vertices of the present wall, deformed by balloons [m], [vertex, 3]; a copy.");
}

void bindProgress(Class& bound)
{
  const auto part = [&bound](const char* name, auto function, const char* documentation)
  {
    bound.def_property_readonly(
        name, [function](OwnedSession& self) { return read(self, function); }, documentation);
  };
  part("reached", &reachedOf,
       "Positions that the handles have reached in the scale of their commands, [instrument, 2]: insertion [m], "
       "rotation "
       "[rad]; a copy. The difference from `hands` is the motion that slipped through the grips, or that faults of the "
       "robot have kept.");
  part(
      "stops", &stopsOf,
      "Least and largest insertion of each instrument at present, [instrument, 2] [m]; infinite without an introducer; "
      "a copy.");
  part(
      "trajectory_hash",
      [](const session::Session& session) { return Hash64::toHex(session.simulation().trajectoryHash()); },
      "Hash over the states of all steps, 16 hexadecimal digits: equal inputs give equal hashes.");
  part(
      "state_hash", [](const session::Session& session) { return Hash64::toHex(session.simulation().stateHash()); },
      "Hash of the state after the last step, 16 hexadecimal digits.");
  part(
      "seed", [](const session::Session& session) { return session.seed(); },
      "Seed of the last reset or loaded state.");
  part(
      "over", [](const session::Session& session) { return session.isOver(); },
      "True after the last step of the run, and where the procedure is complete or has failed.");
  part("procedure", &procedureOf,
       "Progress of the scripted operator: \"running\", \"done\" or \"failed: reason\"; None without a procedure.");
  bound.def_property_readonly(
      "rejected_steps",
      [](OwnedSession& self)
      {
        requireResults(self);
        return Use(self)->record().result().rejectedSteps();
      },
      "Number of steps without a solution, in which the wire was held; needs results=True.");
  bound.def_property_readonly(
      "result",
      [](OwnedSession& self)
      {
        requireResults(self);
        return Use(self)->record().resultJson();
      },
      "Text of result.json after finish(), empty before; needs results=True.");
  bound.def_property(
      "last_step", [](OwnedSession& self) { return Use(self)->lastStep(); },
      [](OwnedSession& self, std::uint64_t step) { Use(self)->setLastStep(step); },
      "Number of the step that ends the run; at first that of the scene's duration.");
  bound.def_property_readonly("world", &OwnedSession::world, "World of the session.");
}

void bindStates(Class& bound)
{
  bound
      .def("save", &save, R"(
State on which the further trajectory depends, as bytes; `simulate --from-state` reads it, too. Load it into any session
of the same scene. Results are not part of it.)")
      .def("load", &load, py::arg("state"), R"(
Continues from a state of save() or `simulate --save-state`, bit for bit. A refused state has no effect. Raises
InputError for a damaged state, or one of another version, scene or vessel.)")
      .def("adopt", &adopt, py::arg("state"), R"(
Takes over the state of a scene with other parameters, e.g. friction, stiffness or limits (World.vary()), but the same
instruments, nodes and vessel: shape, motion, handles and number of steps. Returns what it dropped, a list of texts:
contact forces, and the progress of procedure, commands and results. A refused state has no effect. Raises InputError as
load(), and for other instruments or nodes.)")
      .def("copy", &copied, "Independent session of the same world in the same state, bit for bit.")
      .def("__copy__", &copied)
      .def("__deepcopy__", [](OwnedSession& self, const py::object&) { return copied(self); })
      .def("finish", &finish, py::arg("folder"), py::arg("all") = true, R"(
Ends the results of a session with results=True, and writes them into a folder, which is created: metrics.json,
metrics.html, instruments.csv; with all=True also result.json, scene.yaml, wall_forces.csv, vessel_points.csv.)")
      .def("__reduce__", &reduced);
}

}  // namespace

OwnedSession::OwnedSession(std::shared_ptr<SharedWorld> world, std::uint64_t seed, bool results, bool clients)
  : world_(std::move(world)), results_(results), clients_(clients)
{
  const py::gil_scoped_release released;
  session::SessionSettings settings;
  settings.results = results;
  settings.clients = clients;
  session_ = std::make_unique<session::Session>(world_->pointer(), std::move(settings));
  if (seed != 0)
    session_->reset(seed);
}

OwnedSession::Use::Use(OwnedSession& owner) : owner_(owner)
{
  if (owner.in_use_.exchange(true))
    throw UsageError("the session is in use by another thread; give every thread a session of its own");
  if (owner.session_)
    return;
  owner.in_use_ = false;
  throw UsageError("the session is closed; make another one with world.session()");
}

void OwnedSession::close()
{
  if (isClosed())
    return;
  const Use session(*this);
  session_.reset();
}

void bindSession(py::module_& module)
{
  Class bound(module, "Session", R"(
Run of a world: steps, observations, X-ray images, saved states, results.

Session(world, seed=0, results=False, clients=False), as world.session(...)

seed     varies start and procedure; 0: the scene as it stands
results  True: gathers the results that finish() writes
clients  True: instruments with drive.source topic or device follow command()

Equal inputs give the trajectory of `simulate`, bit for bit. A session can be copied and pickled, and closes as a context
manager. One thread at a time may use it: others raise UsageError, as every use after close() does.)");
  bound.def(py::init<std::shared_ptr<SharedWorld>, std::uint64_t, bool, bool>(), py::arg("world").none(false),
            py::arg("seed") = 0, py::arg("results") = false, py::arg("clients") = false);
  bindRun(bound);
  bindObserving(bound);
  bindProgress(bound);
  bindStates(bound);
  bindHardware(bound);
  bindBlood(bound);
  bindContrast(bound);
  bindMotion(bound);
  bindCine(module, bound);
  module.def("_session_of_pickle", &continued);
  module.attr("World").attr("session") = py::cpp_function(
      [](const std::shared_ptr<SharedWorld>& world, std::uint64_t seed, bool results, bool clients)
      { return std::make_shared<OwnedSession>(world, seed, results, clients); },
      py::name("session"), py::is_method(module.attr("World")), py::arg("seed") = 0, py::arg("results") = false,
      py::arg("clients") = false, "Session at the beginning of the scene; parameters as those of Session.");
}

}  // namespace endovascular_sim::python
