#pragma once

#include <fstream>
#include <string>

#include "simulation/simulation.h"

namespace endovascular_sim::results
{

/** Writes what every step cost, a row per step: times in µs, of the whole step and of its phases, and counts;
 * detections are contact sets asked for. */
class StepCostsFile
{
public:
  /** @throws InputError when the file cannot be written */
  explicit StepCostsFile(const std::string& file);

  /** @param seconds that the last step took */
  void add(const simulation::Simulation& simulation, double seconds);

  /** Hands everything to the operating system. @return false when the disk refused it */
  bool flush();

private:
  std::ofstream stream_;
};

}  // namespace endovascular_sim::results
