#include "simulation/hardware/robot_hardware.h"

#include "common/archive.h"
#include "common/numerics/counter_hash.h"
#include "simulation/simulation.h"

namespace endovascular_sim::simulation
{

RobotHardware::RobotHardware(const scene::Scene& scene, std::uint64_t seed)
  : scene_(&scene),
    seed_(seed),
    faults_(scene.faults, commandsAt(scene, 0.0), scene.solver.time_step, seedOfFaults()),
    sensors_(scene, seed)
{
}

std::uint64_t RobotHardware::seedOfFaults() const
{
  return mixedBits(scene_->seed) ^ seed_;
}

const std::vector<drive::HandCommand>& RobotHardware::execute(const Simulation& simulation,
                                                              const std::vector<drive::HandCommand>& commands)
{
  return faults_.execute(simulation.steps(), commands);
}

drive::HandMotion RobotHardware::reached(const Simulation& simulation, int instrument) const
{
  const drive::HandMotion reached = simulation.reached(instrument);
  const drive::HandMotion& lag = faults_.lag(static_cast<std::size_t>(instrument));
  return {reached.insertion + lag.insertion, reached.rotation + lag.rotation};
}

drive::Interval RobotHardware::stops(const Simulation& simulation, int instrument) const
{
  return simulation.stops(instrument).shifted(faults_.lag(static_cast<std::size_t>(instrument)).insertion);
}

void RobotHardware::setSeed(std::uint64_t seed)
{
  seed_ = seed;
  faults_.setSeed(seedOfFaults());
  sensors_.setSeed(seed);
}

void RobotHardware::restartAt(const Simulation& simulation)
{
  std::vector<drive::HandCommand> commands;
  for (int k = 0; k < simulation.instruments(); ++k)
  {
    const drive::HandMotion reached = simulation.reached(k);
    commands.push_back({reached.insertion, reached.rotation, simulation.hand(k).pressure});
  }
  faults_.restAt(commands);
  sensors_ = Sensors(*scene_, seed_);
}

void RobotHardware::archive(Archive& archive)
{
  std::uint64_t sensors = sensors_.size();
  archive(seed_, sensors, faults_);
  if (sensors != sensors_.size())
    throw ArchiveError("has other sensors than the scene");
  if (archive.reading())
    setSeed(seed_);
  archive(sensors_);
}

}  // namespace endovascular_sim::simulation
