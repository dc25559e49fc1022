#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "benchmark/fuzz/fuzz_random.h"
#include "benchmark/fuzz/wire_check.h"
#include "contact/wall_model.h"
#include "scene/scene_vessel.h"
#include "vessel/model/vessel.h"

namespace endovascular_sim::benchmark
{

/** Vessel of the fuzz with its independent check. */
struct FuzzVessel
{
  std::string name;
  std::string detail;  ///< description of a vessel generated for one episode
  std::shared_ptr<vessel::Vessel> vessel = std::make_shared<vessel::Vessel>();
  std::shared_ptr<const contact::WallModel> wall;  ///< of facets, or the smooth wall of the mesh
  geometry::TriangleMesh checked;                  ///< tessellation of a smooth wall, for the check
  std::unique_ptr<WireCheck> check;
  double narrowest = 1.0;  ///< radius of the narrowest lumen that the wire may enter [m]
  double tightest = 1.0;   ///< smallest known radius of curvature [m]
};

/** Vessels of the fuzz: random channels, random bifurcations, the generated anatomy, and all given meshes that can be
 *  used. Vessels other than channels are built once and retained. */
class FuzzVessels
{
public:
  /** @param mesh_files OBJ, STL or PLY [mm or m]; unusable ones are listed in skipped()
   *  @param smooth whether the walls are smooth (contact::WallShape) */
  explicit FuzzVessels(const std::vector<std::string>& mesh_files, bool smooth = false);

  /** Names of the kinds of vessel, in a fixed order. */
  const std::vector<std::string>& kinds() const { return kinds_; }
  const std::vector<std::string>& skipped() const { return skipped_; }  ///< unused files with the reason

  /** Vessel of a kind, valid until the next call.
   *  @param random determines the channel or the bifurcation */
  FuzzVessel& get(const std::string& kind, FuzzRandom& random);

private:
  FuzzVessel& retain(const std::string& name, vessel::Vessel vessel);

  bool smooth_;
  std::vector<std::string> kinds_;
  std::vector<std::string> skipped_;
  std::map<std::string, std::string> file_of_kind_;
  std::map<std::string, std::unique_ptr<FuzzVessel>> retained_;
  std::unique_ptr<FuzzVessel> channel_;
};

/** Random pose inside an end of the vessel where a straight piece of wire fits.
 *  @param radius radius of the wire [m]
 *  @param length length of the straight piece [m]
 *  @throws InputError if none is found */
scene::EntryPose randomEntry(const FuzzVessel& vessel, FuzzRandom& random, double radius, double length);

}  // namespace endovascular_sim::benchmark
