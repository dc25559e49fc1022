#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "benchmark/fuzz/fuzz_vessels.h"

namespace endovascular_sim::benchmark
{

/** What is fuzzed besides the random choices. */
struct FuzzSettings
{
  std::uint64_t seed = 1;
  int steps_per_episode = 400;
  std::vector<std::string> overrides;  ///< `key.path=value` of every episode's scene
};

/** What became of one episode: one wire in one vessel, pushed, pulled and turned at random. */
struct FuzzEpisode
{
  std::uint64_t number = 0;
  std::string vessel;
  std::string description;  ///< of the wire, its sampling, the time step and the wall
  int steps = 0;
  int looks = 0;                ///< at the whole wire
  int bad_step = -1;            ///< the first with an escape or a NaN; the episode ends there
  bool escaped = false;         ///< a point of the axis is out of the lumen
  bool finite = true;           ///< no NaN
  int refused = 0;              ///< steps without a solution: the wire was held
  int hit_iteration_limit = 0;  ///< sub-steps accepted at the limit of solves
  double depth = 0.0;           ///< largest of the wire's surface beyond the wall, the wall's compliance taken off [m]
  int depth_step = 0;           ///< when it was
  double depth_place = 0;       ///< where: length of wire between the introducer and it [m]
  double force = 0.0;           ///< largest at the hand [N]
  double max_strain = 0.0;
};

/** Depth beyond the wall's compliance that is still good [m]. */
constexpr double kFuzzDepth = 1e-4;

/** Runs episode @p number: what happens in it depends on the seed, its number and the list of vessels' kinds alone.
 *
 *  Wire (EI from 1.6 to 5000 N·mm², straight or pre-curved tip, length, radius), sampling (uniform, adaptive), time
 * step (0.1 to 10 ms), wall (rigid, compliant; friction) and the hand's motion (up to 500 mm/s and 59 rad/s, reversals)
 * are drawn at random. After every tenth step, and where the solver sees more than 50 µm, the whole wire is looked at
 * with WireCheck.
 *  @throws std::logic_error when WireCheck disagrees with itself by looking at every triangle */
FuzzEpisode fuzzEpisode(FuzzVessels& vessels, const FuzzSettings& settings, std::uint64_t number);

}  // namespace endovascular_sim::benchmark
