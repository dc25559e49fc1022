#pragma once

#include <fstream>
#include <string>

#include "simulation/simulation.h"

namespace endovascular_sim::results
{

/** Writer of a CSV file with the cost of each step: times of the step and its phases [µs], and counters. The column
 *  `detections` counts the queried contact sets. */
class StepCostsFile
{
public:
  /** @throws InputError if the file cannot be written */
  explicit StepCostsFile(const std::string& file);

  /** Adds the last step. @param seconds wall time of the step [s] */
  void add(const simulation::Simulation& simulation, double seconds);

  /** Flushes the file to the operating system. @return false on failure */
  bool flush();

private:
  std::ofstream stream_;
};

}  // namespace endovascular_sim::results
