#pragma once

#include <fstream>
#include <string>

#include "session/simulation.h"

namespace endovascular_sim::session
{

/** Writes what every step cost: a row per step, whose columns kStepCostColumns names. */
class StepCostsFile
{
public:
  /** @throws InputError when the file cannot be written */
  explicit StepCostsFile(const std::string& file);

  /** @param seconds that the last step took */
  void add(const Simulation& simulation, double seconds);

  /** Hands everything to the operating system. @return false when the disk refused it */
  bool flush();

private:
  std::ofstream stream_;
};

/** Times in µs: of the whole step and of its phases. Detections: contact sets asked for. */
constexpr auto kStepCostColumns =
    "step,us,solves,factorisations,truncations,capped,contacts,detections,collision_us,assembly_us,solve_us,sampling_"
    "us,"
    "twist_us";

}  // namespace endovascular_sim::session
