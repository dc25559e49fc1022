#include "benchmark/studies/shared_wall.h"

#include <malloc.h>

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "common/time/processor_time.h"
#include "session/session.h"

namespace endovascular_sim::benchmark
{
namespace
{

using WorldPointer = std::shared_ptr<const session::World>;

constexpr int kSessions = 10;          // number of averaged sessions
constexpr int kSteps = 100;            // steps before memory is read, which build the neighbour lists
constexpr int kLoads = 20;             // number of averaged resets and loads
constexpr int kDemoSteps = 3000;       // before the state of `demo` is saved
constexpr int kInflationSteps = 6500;  // before that of `stent`: its balloon is inflated

/** Heap memory in use [B]. */
double heapInUse()
{
  const struct mallinfo2 info = mallinfo2();
  return static_cast<double>(info.uordblks) + static_cast<double>(info.hblkhd);
}

/** Mean processor time of a call [s]. */
double meanTime(int calls, const std::function<void()>& call)
{
  const double begin = processorSeconds();
  for (int k = 0; k < calls; ++k)
    call();
  return (processorSeconds() - begin) / calls;
}

/** Adds the row of a scene.
 *  @param world returns the world of one session
 *  @param state to be loaded */
void addRow(const std::string& scene, const std::string& name, const std::function<WorldPointer()>& world, int sessions,
            const std::string& state, Section& section)
{
  std::vector<session::Session> opened;
  opened.reserve(static_cast<std::size_t>(sessions));
  const double before = heapInUse();
  const double construction = meanTime(sessions, [&] { opened.emplace_back(world()); });
  for (session::Session& session : opened)
    session.step(kSteps);
  const double bytes = (heapInUse() - before) / sessions;
  const double reset = meanTime(kLoads, [&] { opened.front().reset(); });
  const double load = meanTime(kLoads, [&] { opened.front().load(state); });
  section.table.add({scene, name, number(1e-6 * bytes), number(1e3 * construction), number(1e3 * reset),
                     number(1e3 * load), number(1e-6 * static_cast<double>(state.size()))});
}

/** State of a scene after some steps. */
std::string stateOf(const WorldPointer& world, int steps)
{
  session::Session session(world);
  session.step(steps);
  return session.save();
}

}  // namespace

TableSpec sharedWallTable()
{
  return {"speed_shared_wall",
          "A further session of a scene",
          {"scene", "world", "memory [MB]", "processor time of the construction [ms]", "of a reset [ms]",
           "of loading a state [ms]", "state [MB]"},
          ""};
}

Section sharedWallCost(const Progress& progress)
{
  progress(0.99, "memory of a further session");
  Section section({sharedWallTable()}, "speed_shared_wall");
  section.text =
      "Means per session (`session::Session`). A world holds scene, vessel and wall model. Memory is read after " +
      std::to_string(kSteps) +
      " steps. The state of `demo` is that of 3 s, the state of `stent` that of 6.5 s with an inflated balloon, "
      "which has moved the wall.";
  const WorldPointer demo = session::World::open("demo");
  const std::string demo_state = stateOf(demo, kDemoSteps);
  addRow(
      "demo", "shared", [&demo] { return demo; }, kSessions, demo_state, section);
  addRow(
      "demo", "own", [] { return session::World::open("demo"); }, 1, demo_state, section);
  const WorldPointer stent = session::World::open("stent");
  addRow(
      "stent", "shared", [&stent] { return stent; }, kSessions, stateOf(stent, kInflationSteps), section);
  return section;
}

}  // namespace endovascular_sim::benchmark
