#include <gtest/gtest.h>

#include "scene/file_search.h"
#include "scene/sampling_error.h"
#include "scene/scene_file.h"

namespace endovascular_sim::scene
{
namespace
{

SamplingError errorOf(const std::string& name, const std::vector<std::string>& overrides)
{
  const Scene scene = loadScene(configFolder() + "/scenes/" + name, overrides);
  const vessel::Vessel vessel = buildVessel(*scene.vessel, scene.entry, scene.file);
  return expectedSamplingError(scene, vessel, resolveStart(scene, vessel));
}

}  // namespace

TEST(SamplingError, FindsTheBendOfATube)
{
  const SamplingError error = errorOf("tube.yaml", {});
  EXPECT_NEAR(error.bend_radius, 0.030, 1e-3);
  EXPECT_NEAR(error.clearance, 3.0e-3 - 4.445e-4, 5e-5);
  EXPECT_NEAR(error.edge, 0.300 / 149, 1e-6);
}

TEST(SamplingError, IsOfSecondOrderInABendAndOfFirstOrderAtTheIntroducer)
{
  const SamplingError coarse = errorOf("tube.yaml", {"sampling.nodes=101"});
  const SamplingError fine = errorOf("tube.yaml", {"sampling.nodes=201"});
  EXPECT_NEAR(coarse.inBend() / fine.inBend(), 4.0, 1e-6);
  EXPECT_NEAR(coarse.atMouth() / fine.atMouth(), 2.0, 1e-6);
}

TEST(SamplingError, CoversTheMeasuredErrorOfAJWireInAStraightTube)
{
  // docs/validation/sampling_error.csv: 17 % and 7 % in the first second with 241 and 481 nodes.
  const std::vector<std::string> j_wire = {"instrument=instruments/peer_j_wire.yaml", "vessel.tube.radius=6e-3",
                                           "vessel.tube.pieces.1.curvature=0", "drive.initial_insertion=0.0042"};
  std::vector<std::string> coarse = j_wire;
  coarse.emplace_back("sampling.nodes=241");
  std::vector<std::string> fine = j_wire;
  fine.emplace_back("sampling.nodes=481");
  EXPECT_NEAR(errorOf("tube.yaml", coarse).atMouth(), 0.17, 0.03);
  EXPECT_NEAR(errorOf("tube.yaml", fine).atMouth(), 0.07, 0.03);
}

TEST(SamplingError, SaysThatItIsNotKnown)
{
  EXPECT_NE(SamplingError().text().find("not known"), std::string::npos);
}

}  // namespace endovascular_sim::scene
