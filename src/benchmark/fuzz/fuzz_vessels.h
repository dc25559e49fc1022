#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "benchmark/fuzz/fuzz_random.h"
#include "benchmark/fuzz/wire_check.h"
#include "contact/detector.h"
#include "scene/scene_vessel.h"
#include "vessel/model/vessel.h"

namespace endovascular_sim::benchmark
{

/** A vessel to be fuzzed in, with its check. */
struct FuzzVessel
{
  std::string name;
  std::string detail;  ///< of a vessel that is made anew for every episode
  vessel::Vessel vessel;
  std::unique_ptr<WireCheck> check;
  std::unique_ptr<contact::Detector> detector;  ///< of a rigid wall
  int uses = 0;                                 ///< of the detector
  double narrowest = 1.0;                       ///< radius of the narrowest lumen that is meant to be entered [m]
  double tightest = 1.0;                        ///< smallest radius of curvature, where it is known [m]
};

/** The vessels that the fuzz goes round: channels at random, bifurcations at random, the generated anatomy, and every
 *  mesh that is given and loads. Big ones are read once and kept. */
class FuzzVessels
{
public:
  /** @param mesh_files OBJ, STL or PLY [mm or m]; those that do not load are named in skipped() */
  explicit FuzzVessels(const std::vector<std::string>& mesh_files);

  /** Names of the kinds, in a fixed order. */
  const std::vector<std::string>& kinds() const { return kinds_; }
  const std::vector<std::string>& skipped() const { return skipped_; }  ///< files with the reason

  /** A vessel of a kind; what @p random gives decides about channels and which bifurcation. Good until the next call.
   */
  FuzzVessel& get(const std::string& kind, FuzzRandom& random);

private:
  FuzzVessel& keep(const std::string& name, vessel::Vessel vessel);

  std::vector<std::string> kinds_;
  std::vector<std::string> skipped_;
  std::map<std::string, std::string> file_of_kind_;
  std::map<std::string, std::unique_ptr<FuzzVessel>> kept_;
  std::unique_ptr<FuzzVessel> channel_;
};

/** A place well inside of a vessel's end where a straight piece of wire fits, chosen at random.
 *  @param radius of the wire [m]
 *  @param length of the straight piece [m]
 *  @throws InputError when none is found */
scene::EntryPose randomEntry(const FuzzVessel& vessel, FuzzRandom& random, double radius, double length);

}  // namespace endovascular_sim::benchmark
