#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "benchmark/fuzz/fuzz_vessels.h"

namespace endovascular_sim::benchmark
{

/** Settings of the fuzz. */
struct FuzzSettings
{
  std::uint64_t seed = 1;
  int steps_per_episode = 400;
  bool smooth = false;                 ///< smooth walls (vessel.wall: smooth) in place of facets
  bool coaxial = false;                ///< a wire in a catheter, each with a hand of its own
  bool moving = false;                 ///< the vessel moves by 10 mm at 90 beats per minute; hands up to 100 mm/s
  std::vector<std::string> overrides;  ///< overrides `key.path=value` of every scene
};

/** Result of one episode: one wire in one vessel, pushed, pulled and turned at random. */
struct FuzzEpisode
{
  std::uint64_t number = 0;
  std::string vessel;
  std::string description;  ///< description of wire, sampling, time step and wall
  int steps = 0;
  int checks = 0;               ///< number of checks of the whole wire
  int bad_step = -1;            ///< first step with an escape or a NaN, which ends the episode; −1: none
  bool escaped = false;         ///< a point of the axis is outside the lumen
  bool finite = true;           ///< no NaN
  int rejected = 0;             ///< rejected steps, in which the wire was held
  int hit_iteration_limit = 0;  ///< sub-steps accepted at the iteration limit
  double depth = 0.0;           ///< largest penetration depth of the surface minus the compliance of the wall [m]
  int depth_step = 0;           ///< step of the largest depth
  double depth_place = 0;       ///< arc length from the introducer to the largest depth [m]
  double force = 0.0;           ///< largest force on a hand [N]
  double over_grips = 0.0;      ///< largest force on a hand relative to the sum of the grips
  double max_strain = 0.0;
};

/** Largest permitted depth beyond the compliance of the wall [m]. */
constexpr double kFuzzDepth = 1e-4;

/** Largest permitted force on a hand relative to the sum of the grips. */
constexpr double kFuzzOverGrips = 1.02;

/** Runs an episode, which depends only on the seed, its number and the list of vessel kinds.
 *
 *  Wire (EI from 1.6 to 5000 N·mm², straight or pre-curved tip, length, radius), sampling (uniform, adaptive), time
 * step (0.1 to 10 ms), wall (rigid, compliant; friction) and the hand's motion (up to 500 mm/s and 59 rad/s, reversals)
 * are drawn at random. WireCheck checks the whole wire after every tenth step, and after steps with a depth above 50 µm
 * in the solver. A coaxial episode has a catheter over the wire (bore, stiffness and friction at random), whose hand
 * moves by itself.
 *  In a moving vessel, the check after every tenth step is that of the wire at rest. Every tenth of these compares one
 *  node with the moved mesh by brute force, and every twentieth checks the whole wire in the moved mesh.
 *  @throws std::logic_error if WireCheck disagrees with a brute-force search over all triangles */
FuzzEpisode fuzzEpisode(FuzzVessels& vessels, const FuzzSettings& settings, std::uint64_t number);

}  // namespace endovascular_sim::benchmark
