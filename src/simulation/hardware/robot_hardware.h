#pragma once

#include <cstdint>
#include <vector>

#include "robot/command_faults.h"
#include "scene/model/scene.h"
#include "simulation/hardware/sensors.h"

namespace endovascular_sim::simulation
{

/** What stands between a client and the simulated instruments: faults of the robot's drives and sensors. Sessions and
 *  nodes run this same code. */
class RobotHardware
{
public:
  /** @param scene must outlive this object
   *  @param seed of the run, beside that of the scene */
  explicit RobotHardware(const scene::Scene& scene, std::uint64_t seed = 0);

  /** Commands that the handles follow in the next step, of those that were given. */
  const std::vector<drive::HandCommand>& execute(const Simulation& simulation,
                                                 const std::vector<drive::HandCommand>& commands);

  /** Measures; to be called after each step. */
  void measure(const Simulation& simulation)
  {
    if (sensors_.size() > 0)
      sensors_.update(simulation);
  }

  robot::CommandFaults& faults() { return faults_; }
  const robot::CommandFaults& faults() const { return faults_; }
  const Sensors& sensors() const { return sensors_; }

  /** Position that an instrument has reached in the scale of its commands, as if no fault had held it back: that of
   *  Simulation::reached() plus the motion that faults have kept. */
  drive::HandMotion reached(const Simulation& simulation, int instrument) const;

  /** Stops of Simulation::stops() in that scale. */
  drive::Interval stops(const Simulation& simulation, int instrument) const;

  std::uint64_t seed() const { return seed_; }

  /** Varies the errors, losses and faulty intervals from now on. */
  void setSeed(std::uint64_t seed);

  /** Begins again at the present state of a simulation: no sample waits, and no fault has acted. */
  void restartAt(const Simulation& simulation);

  /** True where sensors or faults have data of which the further run depends. */
  bool needsSaving() const { return sensors_.size() > 0 || !faults_.empty(); }

  /** Saves or loads all data. @throws ArchiveError for invalid data */
  void archive(Archive& archive);

private:
  std::uint64_t seedOfFaults() const;

  const scene::Scene* scene_;
  std::uint64_t seed_;
  robot::CommandFaults faults_;
  Sensors sensors_;
};

}  // namespace endovascular_sim::simulation
