#include <chrono>
#include <cstdio>
#include <iostream>
#include <optional>

#include "common/hash.h"
#include "nodes/session/recorded_simulation.h"
#include "nodes/session/session_bag.h"
#include "results/step_costs_csv.h"
#include "tools/command_line.h"
#include "tools/tool_output.h"

namespace
{

using namespace endovascular_sim;  // NOLINT: a program's main file
using Clock = std::chrono::steady_clock;

constexpr int kDifferent = 1;   ///< exit code: a step differs
constexpr int kIncomplete = 3;  ///< exit code: all compared steps are equal, but not every step was compared

/** Prints the outcome. @return exit code */
int report(const nodes::ReplayOutcome& outcome, const nodes::RecordedSimulation& session, const std::string& file)
{
  const auto number = [](std::uint64_t value) { return std::to_string(value); };
  if (outcome.first_different)
    std::cerr << "replay: step " << *outcome.first_different << " differs: recorded "
              << Hash64::toHex(outcome.recorded_hash) << ", computed " << Hash64::toHex(outcome.computed_hash) << "\n";
  const std::string compared = number(outcome.compared) + " of " + number(outcome.steps) + " steps compared, ";
  const std::string trajectory = "trajectory " + Hash64::toHex(session.simulation().trajectoryHash()) + "\n";
  if (outcome.different > 0 || outcome.incomplete.empty())
  {
    std::cout << compared << outcome.different << " different, " << trajectory;
    return outcome.different > 0 ? kDifferent : 0;
  }
  std::cout << compared << "all of them equal, but the recording is incomplete, " << trajectory;
  std::cerr << "replay: " << file << ": " << outcome.incomplete
            << ". Steps after the missing one cannot be computed; use a complete copy of the bag\n";
  return kIncomplete;
}

int replay(const std::string& file, bool keep_going, const std::string& costs_file)
{
  std::optional<results::StepCostsFile> costs;
  if (!costs_file.empty())
    costs.emplace(costs_file);
  const nodes::SessionBag recording = nodes::readSessionBag(file);
  nodes::RecordedSimulation session(recording, file);
  const auto steps = static_cast<double>(recording.steps.size());
  Clock::time_point before = Clock::now();
  const auto after = [&]
  {
    const simulation::Simulation& simulation = session.simulation();
    if (costs)
      costs->add(simulation, std::chrono::duration<double>(Clock::now() - before).count());
    if (simulation.steps() % 1000 == 0)
      std::fprintf(stderr, "\r%3.0f %% ", 100.0 * static_cast<double>(simulation.steps()) / steps);
    before = Clock::now();
  };
  const nodes::ReplayOutcome outcome = nodes::replay(recording, session, keep_going, after);
  std::fprintf(stderr, "\r");
  if (costs)
    tools::requireWritten(costs->flush(), costs_file);
  return report(outcome, session, file);
}

}  // namespace

int main(int argc, char** argv)
{
  std::string file;
  std::string costs;
  bool keep_going = false;
  tools::CommandLine line(
      "replay",
      "Simulates a recorded session again from its inputs and compares every step with the recording, bit for bit.",
      "The scene, the vessel and the inputs of every step come from the bag. To view a session without computing it "
      "again: "
      "roslaunch endovascular_sim replay.launch bag:=SESSION.bag\n"
      "Exit code: 0 every step of the session was compared and all are equal; 1 a step differs, or the bag cannot be "
      "used; 2 wrong arguments; 3 all compared steps are equal, but the recording is incomplete or damaged.");
  line.argument("SESSION.bag", file, "bag of the session node; its index is not needed");
  line.flag("--keep-going", keep_going, "counts all steps that differ instead of ending at the first one");
  line.option("--costs", costs, "FILE", "writes time, solves and contacts of every step as CSV (docs/SIMULATE.md)");
  return line.run(argc, argv, [&] { return replay(file, keep_going, costs); });
}
