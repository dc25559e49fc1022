#pragma once

#include <string>
#include <vector>

#include "benchmark/harness/bench_wire.h"

namespace endovascular_sim::benchmark
{

/** A static problem with a known tip position. */
struct StaticCase
{
  std::string name;
  std::string source;   ///< of the reference value
  BenchWire wire;       ///< nodes, scheme and time step are set by the study
  Eigen::Vector3d tip;  ///< exact, of the free part's length 1 [m/m]
};

/** Elastica with a tip force, heavy elastica, circular arcs with loads in and out of their plane. */
std::vector<StaticCase> staticCases();

/** The wire of the published comparison: 380 mm under gravity, wL³/EI = 8.75. */
StaticCase heavyCantilever();

/** Distance of the computed tip from the exact one, in lengths of the wire. */
double tipError(const StaticCase& problem, const RestResult& result);

/** The case with a scheme, nodes and a time step in which that scheme comes to rest. */
BenchWire atRest(const StaticCase& problem, const std::string& scheme, int nodes);

/** Limit of steps for that. */
int restSteps(const std::string& scheme);

}  // namespace endovascular_sim::benchmark
