#include "cine.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <string>
#include <vector>

#include <pybind11/numpy.h>
#include <pybind11/stl.h>

#include "commands.h"
#include "common/error.h"
#include "session/x_ray_run.h"
#include "signals.h"
#include "zeroed.h"

namespace endovascular_sim::python
{
namespace py = pybind11;
namespace
{

/** Frames of a run as Python sees them; its arrays are copies. */
struct Cine : Zeroed
{
  py::array_t<std::uint64_t> pulses, steps;
  py::array_t<double> times;
  py::array images, raw, subtracted;
};

/** Frames of a run, of all detectors one after the other. */
struct Frames
{
  std::vector<std::uint64_t> pulses, steps;
  std::vector<double> times;
  std::vector<std::uint8_t> images, subtracted;
  std::vector<std::uint16_t> raw;
  py::ssize_t pixels = 0, detectors = 0;
  py::ssize_t subtracted_frames = 0;
};

void append(const session::XRayRun& run, const simulation::Simulation& simulation, bool raw, Frames& frames)
{
  frames.pulses.push_back(run.frame().pulse);
  frames.steps.push_back(simulation.steps());
  frames.times.push_back(simulation.time());
  frames.subtracted_frames += run.frame().subtracted.empty() ? 0 : 1;
  frames.detectors = static_cast<py::ssize_t>(run.detectors());
  for (std::size_t detector = 0; detector < run.detectors(); ++detector)
  {
    const fluoroscopy::AngiographyFrame& frame = run.frame(detector);
    frames.pixels = frame.native.pixels;
    frames.images.insert(frames.images.end(), frame.native.image.begin(), frame.native.image.end());
    frames.subtracted.insert(frames.subtracted.end(), frame.subtracted.begin(), frame.subtracted.end());
    if (raw)
      frames.raw.insert(frames.raw.end(), frame.native.raw.begin(), frame.native.raw.end());
  }
}

/** Draws the pulses from the present step on, for a number of steps. */
Frames takeFrames(session::Session& session, session::XRayRun& run, std::uint64_t steps,
                  const std::vector<StepCommands>& commands, bool raw)
{
  Frames frames;
  SignalCheck handle_signals;
  for (std::uint64_t k = 0;; ++k)
  {
    if (run.isDue(session.simulation()))
    {
      run.draw(session);
      append(run, session.simulation(), raw, frames);
    }
    if (k == steps)
      break;
    if (!commands.empty())
      session.step(commands.front());
    else if (session.step() == 0)
      break;
    handle_signals();
  }
  return frames;
}

template <typename Pixel>
py::array framesArray(const Frames& frames, const std::vector<Pixel>& values, py::ssize_t count)
{
  if (frames.detectors > 1)
    return py::array_t<Pixel>({count, frames.detectors, frames.pixels, frames.pixels}, values.data());
  return py::array_t<Pixel>({count, frames.pixels, frames.pixels}, values.data());
}

template <typename Value>
py::array_t<Value> columnOf(const std::vector<Value>& values)
{
  return py::array_t<Value>(static_cast<py::ssize_t>(values.size()), values.data());
}

std::vector<std::string> viewsOf(const py::object& view)
{
  if (py::isinstance<py::str>(view))
    return {view.cast<std::string>()};
  try
  {
    return view.cast<std::vector<std::string>>();
  }
  catch (const py::cast_error&)
  {
    throw InputError("view", py::repr(view).cast<std::string>(), "is neither a view nor a sequence of two");
  }
}

Cine cine(OwnedSession& owner, double seconds, const py::object& view, int dsa, const std::array<double, 2>& shift,
          bool raw, const py::object& commands, const std::optional<double>& roadmap)
{
  const OwnedSession::Use session(owner);
  if (!(seconds >= 0.0 && seconds < 1e6))
    throw InputError("seconds", std::to_string(seconds), "is no duration; give 0 to 1e6 s");
  if (dsa < 0)
    throw InputError("dsa", std::to_string(dsa), "is below 0; give the number of frames of the mask");
  session::XRayRunSettings settings;
  settings.views = viewsOf(view);
  settings.mask_frames = dsa;
  settings.shift = Eigen::Vector2d(shift[0], shift[1]);
  if (roadmap)
    settings.roadmap_at = session->simulation().time() + *roadmap;
  std::vector<StepCommands> held;
  if (!commands.is_none())
    held = commandsFrom(commandArray(commands), session->scene());
  if (held.size() > 1)
    throw InputError("commands", "", "has one command for each step; give [instrument, 3], which is held");
  const auto steps = static_cast<std::uint64_t>(std::llround(seconds / session->scene().solver.time_step));
  Frames frames;
  {
    const py::gil_scoped_release released;
    session::XRayRun run(session->world(), settings);
    const std::uint64_t now = session->simulation().steps();
    if (dsa > 0)
      run.requireFrames(run.pulses().firstFrom(now), run.pulses().newestAt(now + steps));
    frames = takeFrames(*session, run, steps, held, raw);
  }
  const auto count = static_cast<py::ssize_t>(frames.pulses.size());
  Cine result;
  result.pulses = columnOf(frames.pulses);
  result.steps = columnOf(frames.steps);
  result.times = columnOf(frames.times);
  result.images = framesArray(frames, frames.images, count);
  result.raw = framesArray(frames, frames.raw, raw ? count : 0);
  result.subtracted = framesArray(frames, frames.subtracted, frames.subtracted_frames);
  return result;
}

}  // namespace

void bindCine(py::module_& module, py::class_<OwnedSession, std::shared_ptr<OwnedSession>>& session)
{
  py::class_<Cine>(module, "Cine", R"(
Run of X-ray frames, of Session.cine(). All arrays are copies. With two views the arrays of images have the detector as
their second axis.)")
      .def_readonly("pulses", &Cine::pulses, "Numbers of the pulses, [frame].")
      .def_readonly("steps", &Cine::steps, "Numbers of steps before them, [frame].")
      .def_readonly("times", &Cine::times, "Simulated times [s], [frame].")
      .def_readonly("images", &Cine::images, "Display images, uint8 [frame, pixels, pixels].")
      .def_readonly("raw", &Cine::raw,
                    "Signals of the detector, uint16 [frame, pixels, pixels]; empty unless raw=True.")
      .def_readonly("subtracted", &Cine::subtracted,
                    "Display images of DSA, uint8 [frame, pixels, pixels], from the frame after the mask on.")
      .def("__len__", [](const Cine& self) { return self.pulses.size(); })
      .def("__repr__", [](const Cine& self) { return "<Cine of " + std::to_string(self.pulses.size()) + " frames>"; });
  session.def("cine", &cine, py::arg("seconds"), py::arg("view") = "", py::arg("dsa") = 0,
              py::arg("shift") = std::array<double, 2>{0.0, 0.0}, py::arg("raw") = false,
              py::arg("commands") = py::none(), py::arg("roadmap") = py::none(), R"(
Advances the simulation and takes X-ray frames at its pulses, that of the present step included; a Cine. Frames are those
of `simulate --cine` and of the node of fluoroscopy, bit for bit. It ends early where the run ends.

seconds   simulated time [s]
view      in clinical notation, e.g. "LAO 40"; empty: that of the scene; two views: biplane
dsa       number of frames of the mask, which is subtracted from those after it; 0: no DSA
shift     of the mask, towards larger columns and rows [pixel]
raw       True: with the signals of the detector
commands  positions of the handles, held for all steps [instrument, 3]; None: by the scene's drives, as step()
roadmap   time after which the run of DSA ends, and frames show its roadmap [s]; None: no roadmap

Raises InputError for a scene without fluoroscopy, an unknown view, and impossible values.)");
}

}  // namespace endovascular_sim::python
