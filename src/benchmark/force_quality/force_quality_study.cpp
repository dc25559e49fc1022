#include "benchmark/force_quality/force_quality_study.h"

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "common/error.h"
#include "scene/file_search.h"
#include "scene/scene_file.h"
#include "session/session.h"

namespace endovascular_sim::benchmark
{
namespace
{

constexpr double kSeconds = 30.0;      // s per scene
constexpr double kQuickSeconds = 3.0;  // s
constexpr double kSpeed = 20e-3;       // m/s, of instruments that clients drive
constexpr double kTurning = 1.0;       // rad/s
constexpr double kTurned = 1.0;        // rad to both sides
constexpr double kLeastForce = 1e-3;   // N: mean below which a relative deviation says nothing
constexpr double kLeastTorque = 1e-6;  // N·m
constexpr double kShare = 0.3;         // s in which one of several such instruments moves

/** Names of the scenes of config/scenes. */
std::vector<std::string> shippedScenes()
{
  std::vector<std::string> names;
  for (const auto& entry : std::filesystem::directory_iterator(scene::configFolder() + "/scenes"))
    if (entry.path().extension() == ".yaml")
      names.push_back(entry.path().stem().string());
  std::sort(names.begin(), names.end());
  return names;
}

/** Rotation that goes to and fro at a constant rate, from 0 [rad]. */
double toAndFro(double time)
{
  const double phase = std::fmod(time * kTurning, 4.0 * kTurned);
  return phase < kTurned ? phase : phase < 3.0 * kTurned ? 2.0 * kTurned - phase : phase - 4.0 * kTurned;
}

/** Commands of the scene's procedure or drives; instruments that clients drive are moved in turn. */
class Hands
{
public:
  explicit Hands(const scene::Scene& scene) : scene_(scene)
  {
    for (std::size_t k = 0; k < scene_.instruments.size(); ++k)
      if (scene_.instruments[k].drive.source == scene::DriveSource::kTopic)
        moved_.push_back({k, scene_.instruments[k].drive.initial_insertion});
  }

  /** True at the end of the scene; without instruments that clients drive also at that of its procedure. */
  bool isOver(const session::Session& session) const
  {
    return moved_.empty() ? session.isOver() : session.observe().step() >= session.lastStep();
  }

  /** Advances by a step. */
  void step(session::Session& session)
  {
    if (moved_.empty())
      session.step();
    else
      session.step(next(session.observe().step()));
  }

private:
  struct Moved
  {
    std::size_t instrument;
    double insertion;  ///< [m]
  };

  std::vector<drive::HandCommand> next(std::uint64_t step)
  {
    const double time = static_cast<double>(step + 1) * scene_.solver.time_step;
    std::vector<drive::HandCommand> commands = simulation::commandsAt(scene_, time);
    const auto turn = static_cast<std::size_t>(time / kShare);
    moved_[moved_.size() - 1 - turn % moved_.size()].insertion += kSpeed * scene_.solver.time_step;
    for (const Moved& moved : moved_)
    {
      commands[moved.instrument].insertion = moved.insertion;
      commands[moved.instrument].rotation = toAndFro(time);
    }
    return commands;
  }

  const scene::Scene& scene_;
  std::vector<Moved> moved_;
};

void addRow(const std::string& scene, const std::string& instrument, double seconds, const HandQuality& quality,
            Table& table)
{
  const ReactionQuality& force = quality.force;
  const ReactionQuality& torque = quality.torque;
  const bool pushed = force.windows > 0 && force.mean > 0.0;
  const bool turned = torque.windows > 0 && torque.mean > 0.0;
  if (!pushed && !turned)
    return;
  table.add({scene, instrument, number(seconds), std::to_string(force.windows), pushed ? number(1e3 * force.mean) : "",
             pushed ? number(1e3 * force.largest_change) : "", number(force.change_time, 5),
             force.mean > kLeastForce ? number(100.0 * force.noise()) : "", std::to_string(torque.windows),
             turned ? number(1e6 * torque.mean) : "", turned ? number(1e6 * torque.largest_change) : "",
             number(torque.change_time, 5), torque.mean > kLeastTorque ? number(100.0 * torque.noise()) : ""});
}

/** Adds the rows of a shipped scene. @throws InputError where its mesh is missing */
void addScene(const std::string& name, const std::vector<std::string>& overrides, double seconds, Table& table)
{
  const scene::Scene scene = scene::loadScene(scene::configFolder() + "/scenes/" + name + ".yaml", overrides);
  const std::vector<std::vector<HandReaction>> reactions = reactionsIn(name, overrides, seconds);
  for (std::size_t k = 0; k < reactions.size(); ++k)
    addRow(name, scene.instruments[k].instrument.name,
           static_cast<double>(reactions[k].size()) * scene.solver.time_step,
           handQuality(reactions[k], scene.solver.time_step), table);
}

}  // namespace

std::vector<std::vector<HandReaction>> reactionsIn(const std::string& scene, const std::vector<std::string>& overrides,
                                                   double seconds)
{
  session::Session session(scene, overrides);
  const simulation::Simulation& simulation = session.simulation();
  Hands hands(session.scene());
  std::vector<std::vector<HandReaction>> reactions(static_cast<std::size_t>(simulation.instruments()));
  while (!hands.isOver(session) && simulation.time() < seconds)
  {
    hands.step(session);
    for (int k = 0; k < simulation.instruments(); ++k)
    {
      const simulation::HandState hand = simulation.hand(k);
      reactions[static_cast<std::size_t>(k)].push_back({hand.insertion, hand.rotation, hand.force, hand.torque});
    }
  }
  return reactions;
}

std::vector<TableSpec> forceQualityTables()
{
  return {{"force_quality",
           "Quality of force and torque at the hands of the shipped scenes",
           {"scene", "instrument", "simulated [s]", "windows pushed", "mean force [mN]",
            "largest change of the force [mN/ms]", "at [s]", "deviation of the force [%]", "windows turned",
            "mean torque [µN·m]", "largest change of the torque [µN·m/ms]", "at [s] (torque)",
            "deviation of the torque [%]"},
           ""}};
}

std::vector<Section> forceQualityStudy(const StudyOptions& options, const Progress& progress)
{
  std::vector<Section> sections = {Section(forceQualityTables(), "force_quality")};
  const double seconds = std::isfinite(options.seconds) ? options.seconds : options.quick ? kQuickSeconds : kSeconds;
  std::string omitted;
  const std::vector<std::string> scenes = shippedScenes();
  for (std::size_t k = 0; k < scenes.size(); ++k)
  {
    progress(static_cast<double>(k) / static_cast<double>(scenes.size()), scenes[k]);
    std::vector<std::string> overrides;
    if (scenes[k] == "peer_wire")
      overrides.push_back("vessel.mesh=" +
                          (options.vessel_mesh.empty() ? "aortic_arch_tree.obj" : options.vessel_mesh));
    try
    {
      addScene(scenes[k], overrides, seconds, sections[0].table);
    }
    catch (const InputError& error)
    {
      if (std::string(error.what()).find("vessel.mesh") == std::string::npos)
        throw;
      omitted += (omitted.empty() ? "" : ", ") + ("`" + scenes[k] + "`");
    }
  }
  sections[0].text =
      "Every scene of `config/scenes` over its first " + number(seconds) +
      " s, or the time of `--seconds`. Windows of 0.25 s count in which the handle moves in one direction "
      "without a pause, also 10 ms before and after: pushed or pulled by at least 1 mm/s for the force, turned by at "
      "least 0.05 rad/s "
      "for the torque. The change is the largest one over a millisecond within a window. The deviation is "
      "the mean over the windows of the standard deviation about the linear trend, over the mean "
      "magnitude; it is left out for means below 1 mN and 1 µN·m. Instruments that clients drive are pushed at 20 mm/s "
      "and turned at 1 rad/s by the "
      "study. Instruments that never move so are omitted.";
  if (!omitted.empty())
    sections[0].text += " Omitted for lack of their meshes: " + omitted + ".";
  return sections;
}

}  // namespace endovascular_sim::benchmark
