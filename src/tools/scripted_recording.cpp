#include <unistd.h>

#include <filesystem>
#include <iostream>
#include <string>
#include <system_error>

#include "common/error.h"
#include "common/output_file.h"
#include "common/progress.h"
#include "common/quantities.h"
#include "common/text/format.h"
#include "nodes/session/offline_bag.h"
#include "scene/scene_file.h"
#include "session/session.h"
#include "session/step_states.h"
#include "tools/command_line.h"
#include "tools/tool_output.h"

namespace
{

using namespace endovascular_sim;  // NOLINT: a program's main file

struct Options
{
  std::string scene, out;
  std::vector<std::string> overrides;
  double seconds = 0.0;
  bool quiet = false;
};

/** Keeps the state at the beginning of each step of the procedure as a file. */
void saveStep(const std::string& folder, session::Session& session, session::StepStates& states)
{
  if (session.scriptedOperator() == nullptr ||
      !states.follow(*session.scriptedOperator(), [&session] { return session.save(); }))
    return;
  writeTextFile(folder + formatted("/step_%02zu.state", states.present() + 1), *states.at(states.present()));
}

int record(const Options& options)
{
  session::SessionSettings settings;
  settings.results = true;
  session::Session session(options.scene, options.overrides, settings,
                           options.quiet ? ProgressReport() : progressOnErrorStream());
  tools::printWarnings("scripted_recording", session.scene().warnings);
  if (options.seconds > 0.0)
    session.setLastStep(static_cast<std::uint64_t>(options.seconds / session.scene().solver.time_step + 0.5));
  std::error_code error;
  std::filesystem::create_directories(options.out + "/steps", error);
  if (error)
    throw InputError(options.out, "--out", "the folder cannot be created (" + error.message() + ")");
  session.prepareInflation();
  nodes::OfflineBag bag(options.out + "/session.bag", session, "scripted operator");
  session::StepStates states;
  const bool shows_progress = !options.quiet && isatty(STDERR_FILENO) != 0;
  while (!session.isOver())
  {
    session.step();
    bag.addStep(session);
    saveStep(options.out + "/steps", session, states);
    if (shows_progress && session.simulation().steps() % 500 == 0)
      tools::drawProgress(static_cast<double>(session.simulation().steps()) / static_cast<double>(session.lastStep()),
                          "");
  }
  bag.close();
  session.finish(options.out);
  const procedure::Operator* scripted = session.scriptedOperator();
  if (scripted == nullptr || scripted->progress() != procedure::Progress::kFailed)
    return 0;
  std::cerr << "scripted_recording: the procedure failed: " << scripted->failure() << "\n";
  return 1;
}

}  // namespace

int main(int argc, char** argv)
{
  Options options;
  tools::CommandLine line(
      "scripted_recording",
      "Runs a scene offline with its scripted operator and profiles, and records it as the session node does: "
      "session.bag, which can be played and replayed, with metrics and report, and the state at the beginning of every "
      "step of the procedure (steps/step_01.state and so on).",
      "Exit code: 0 success; 1 failure (the reason is on the error stream); 2 wrong arguments.");
  line.argument("SCENE", options.scene, "YAML file of the scene, or its name in config/scenes");
  line.option("--out", options.out, "DIR", "folder of the recording, created if missing")->required();
  line.overrides(options.overrides, "replaces a value of the scene");
  line.quantity("--seconds", options.seconds, "S", quantities::kDuration,
                "longest simulated time [s]; by default the duration of the scene");
  line.flag("--quiet", options.quiet, "prints no progress");
  line.require(
      [&options]() -> std::string
      {
        return std::filesystem::exists(options.out + "/session.bag")
                   ? "--out: " + options.out + " already contains a session; choose another folder"
                   : "";
      });
  return line.run(argc, argv, [&] { return record(options); });
}
