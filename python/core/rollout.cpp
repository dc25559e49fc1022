#include "rollout.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <optional>

#include <pybind11/stl.h>

#include "arrays.h"
#include "common/error.h"
#include "common/hash.h"
#include "parallel.h"
#include "session.h"
#include "simulation/contact_forces.h"

namespace endovascular_sim::python
{
namespace py = pybind11;
namespace
{

constexpr double kTipLength = 5e-3;  ///< length of the wire whose wall forces add to the tip force [m]

/** Largest forces of several steps [N]. */
struct PeakRow
{
  double wall_force, tip_force, hand_force;
};

/** Takes the forces of the last step into account: those of Observation::forces(), whose places are not needed. */
void update(PeakRow& peak, const session::Session& session)
{
  const session::Observation& seen = session.observe();
  const std::vector<Eigen::Vector3d>& wall_force = session.simulation().state().wall_force;
  const std::vector<double>& arc = session.simulation().discretisation().position;
  Eigen::Vector3d tip = Eigen::Vector3d::Zero();
  for (auto i = static_cast<std::size_t>(seen.firstNode()); i < wall_force.size(); ++i)
  {
    if (wall_force[i].isZero(0.0))
      continue;
    peak.wall_force = std::max(peak.wall_force, wall_force[i].norm());
    if (arc[i] > arc.back() - kTipLength)
      tip += wall_force[i] + simulation::wallFriction(session.simulation(), static_cast<int>(i));
  }
  peak.tip_force = std::max(peak.tip_force, tip.norm());
  for (int k = 0; k < seen.instruments(); ++k)
    peak.hand_force = std::max(peak.hand_force, std::abs(seen.hand(k).force));
}

// ---------------------------------------------------------------------------------------------------------- advance

using Uses = std::vector<std::unique_ptr<OwnedSession::Use>>;

/** Commands of every session; empty elements where there are none.
 *  @throws InputError unless there is one element of the batch per session */
std::vector<std::vector<StepCommands>> commandsOf(const Uses& sessions, const py::object& commands)
{
  if (commands.is_none())
    return std::vector<std::vector<StepCommands>>(sessions.size());
  std::vector<std::vector<StepCommands>> batch = batchFrom(commandArray(commands), (*sessions.front())->scene());
  if (batch.size() != sessions.size())
    throw InputError("commands", "",
                     "are for " + std::to_string(batch.size()) + " sessions, not " + std::to_string(sessions.size()));
  return batch;
}

/** Steps a session by commands, without any by its drives and clients, and notes the largest forces. */
void step(session::Session& session, const std::vector<StepCommands>& commands, std::size_t steps, PeakRow& peak,
          const StepEnd& step_end)
{
  peak = {};
  for (std::size_t k = 0; k < steps; ++k)
  {
    if (commands.empty())
      session.step();
    else
      session.step(commands[k]);
    update(peak, session);
    step_end();
  }
}

/** @throws InputError unless all sessions have instruments that take the same commands */
void requireEqualInstruments(const Uses& uses)
{
  const auto& first = (**uses.front()).scene().instruments;
  for (std::size_t k = 1; k < uses.size(); ++k)
  {
    const auto& other = (**uses[k]).scene().instruments;
    if (!std::equal(first.begin(), first.end(), other.begin(), other.end(),
                    [](const auto& a, const auto& b)
                    { return a.instrument.balloon.has_value() == b.instrument.balloon.has_value(); }))
      throw InputError("advance", "sessions." + std::to_string(k),
                       "has other instruments than the first session; advance sessions of equal instruments together");
  }
}

py::array_t<PeakRow> advance(const std::vector<std::shared_ptr<OwnedSession>>& sessions, const py::object& commands,
                             int threads, const std::optional<std::size_t>& n)
{
  if (commands.is_none() == !n)
    throw InputError("advance", "", "needs either commands or a number of steps n");
  Uses uses;
  for (const std::shared_ptr<OwnedSession>& session : sessions)
    uses.push_back(std::make_unique<OwnedSession::Use>(*session));
  py::array_t<PeakRow> peaks(static_cast<py::ssize_t>(sessions.size()));
  if (sessions.empty())
    return peaks;
  requireEqualInstruments(uses);
  const std::vector<std::vector<StepCommands>> batch = commandsOf(uses, commands);
  PeakRow* rows = peaks.mutable_data();
  runParallel(sessions.size(), threads,
              [&](std::size_t k, const StepEnd& step_end)
              { step(**uses[k], batch[k], n.value_or(batch[k].size()), rows[k], step_end); });
  return peaks;
}

// ---------------------------------------------------------------------------------------------------------- rollout

/** Result of rollout(); arrays that no session refers to. */
struct Rollout : Zeroed
{
  std::vector<std::string> hashes;
  py::array_t<HandRow> hands;
  py::array_t<TipRow> tips;
  py::array_t<PeakRow> peaks;
};

/** Where one run of a rollout writes. */
struct Rows
{
  std::string* hash;
  HandRow* hands;
  TipRow* tips;
  PeakRow* peak;
};

void run(session::Session& session, const std::vector<StepCommands>& commands, std::size_t every, const Rows& rows,
         const StepEnd& step_end)
{
  const int instruments = session.observe().instruments();
  std::size_t row = 0;
  *rows.peak = {};
  for (std::size_t k = 0; k < commands.size(); ++k)
  {
    session.step(commands[k]);
    update(*rows.peak, session);
    if ((k + 1) % every == 0)
      for (int i = 0; i < instruments; ++i, ++row)
      {
        rows.hands[row] = handRow(session.observe(), i);
        rows.tips[row] = tipRow(session.observe(), i);
      }
    step_end();
  }
  *rows.hash = Hash64::toHex(session.simulation().trajectoryHash());
}

Rollout rollout(const SharedWorld& shared, const py::object& commands, int threads,
                const std::optional<std::string>& state, std::int64_t every)
{
  if (every < 1)
    throw InputError("every", std::to_string(every), "is below 1; give the number of steps from sample to sample");
  const std::vector<std::vector<StepCommands>> batch = batchFrom(commandArray(commands), shared.scene());
  const auto runs = static_cast<py::ssize_t>(batch.size());
  const auto instruments = static_cast<py::ssize_t>(shared.scene().instruments.size());
  const auto samples = static_cast<py::ssize_t>(batch.empty() ? 0 : batch.front().size()) / every;
  Rollout made{{},
               std::vector<std::string>(batch.size()),
               py::array_t<HandRow>({runs, samples, instruments}),
               py::array_t<TipRow>({runs, samples, instruments}),
               py::array_t<PeakRow>(runs)};
  HandRow* hands = made.hands.mutable_data();
  TipRow* tips = made.tips.mutable_data();
  PeakRow* peaks = made.peaks.mutable_data();
  const auto stride = static_cast<std::size_t>(samples * instruments);
  runParallel(batch.size(), threads,
              [&](std::size_t k, const StepEnd& step_end)
              {
                session::Session session(shared.pointer());
                if (state)
                  session.load(*state);
                run(session, batch[k], static_cast<std::size_t>(every),
                    {&made.hashes[k], hands + k * stride, tips + k * stride, peaks + k}, step_end);
              });
  return made;
}

}  // namespace

void bindRollout(py::module_& module)
{
  PYBIND11_NUMPY_DTYPE(PeakRow, wall_force, tip_force, hand_force);
  py::class_<Rollout>(module, "Rollout", "Result of rollout(). A sample is taken after every `every` steps.")
      .def_property_readonly(
          "hashes", [](const Rollout& self) { return py::tuple(py::cast(self.hashes)); },
          "Trajectory hash of each run, 16 hexadecimal digits, a tuple.")
      .def_readonly("hands", &Rollout::hands, "Structured array [batch, sample, instrument], as Session.hands.")
      .def_readonly("tips", &Rollout::tips, "Structured array [batch, sample, instrument], as Session.tips.")
      .def_readonly("peaks", &Rollout::peaks, "Structured array [batch], as the result of advance().");
  module.def("rollout", &rollout, py::arg("world"), py::arg("commands"), py::arg("threads") = 0,
             py::arg("state") = py::none(), py::arg("every") = 1, R"(
Independent runs of a world, each in a session of its own, in C++ threads without the GIL.

commands  [batch, step, instrument, 3], as for Session.step()
threads   number of threads; 0: one per processor. The results do not depend on it
state     of Session.save(), with which each run begins; None: the beginning of the scene
every     number of steps from sample to sample

Returns a Rollout. Ctrl-C ends the call. Raises InputError as Session.step() and Session.load().)");
  module.def("advance", &advance, py::arg("sessions"), py::arg("commands") = py::none(), py::arg("threads") = 0,
             py::arg("n") = py::none(), R"(
Steps several sessions of equal instruments at a time, in C++ threads without the GIL.

sessions  list of Session, each once
commands  [batch, step, instrument, 3], as for Session.step(), one element of the batch per session;
          None: n steps by the drives of the scene and by Session.command()

Returns the largest forces of these steps [N], a structured array [batch]: wall_force, the largest normal force of one
contact; tip_force, the largest resultant of the wall's forces on the distal 5 mm; hand_force, the largest magnitude at a
handle. Raises InputError as Session.step(), before the first step.)");
}

}  // namespace endovascular_sim::python
