#pragma once

#include <string>
#include <vector>

#include "benchmark/harness/bench_wire.h"

namespace endovascular_sim::benchmark
{

/** Static problem with a known tip position. */
struct StaticCase
{
  std::string name;
  std::string source;   ///< method of the reference value
  BenchWire wire;       ///< nodes, scheme and time step are set by the study
  Eigen::Vector3d tip;  ///< exact position of the tip over the free length [1]
};

/** Elastica with a tip force, heavy elastica, and circular arcs with loads in and out of their plane. */
std::vector<StaticCase> staticCases();

/** Wire of the published comparison: 380 mm under gravity, wL³/EI = 8.75. */
StaticCase heavyCantilever();

/** Distance between the computed and the exact tip over the length of the wire. */
double tipError(const StaticCase& problem, const RestResult& result);

/** Wire of the case with the given scheme and nodes, and with a time step suitable for that scheme to reach rest. */
BenchWire atRest(const StaticCase& problem, const std::string& scheme, int nodes);

/** Limit of steps of a run to rest. */
int restSteps(const std::string& scheme);

}  // namespace endovascular_sim::benchmark
