#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "scene/scene_file.h"

// Warnings of the schema about values that fit together badly.

namespace endovascular_sim::scene
{
namespace
{

/** Warnings of a scene with a wire of 0.38 m and a guide of 19 mm. */
std::vector<std::string> warningsOf(const std::string& sampling, const std::string& more = "")
{
  return parseScene(
             "name: s\nvessel: none\nentry: {position: [0, 0, 0], direction: [0, 0, 1], up: [1, 0, 0]}\n"
             "instrument: {name: wire, sections: [{length: 0.38, radius: 4e-4, young_modulus: 2.0e10, "
             "poisson_ratio: 0.3, density: 6000, material: nitinol}]}\ndrive: {source: topic}\nsampling: " +
                 sampling + "\n" + more,
             "s.yaml")
      .warnings;
}

}  // namespace

TEST(SceneSchema, EdgesLongerThanAQuarterOfTheGuideGiveAWarningWithKeyAndRemedy)
{
  const std::vector<std::string> warnings = warningsOf("{nodes: 80}");  // 4.81 mm
  ASSERT_EQ(warnings.size(), 1U);
  EXPECT_EQ(warnings[0],
            "s.yaml: sampling.nodes (line 6): edges of 0.004810 m are longer than a quarter of solver.guide_length, "
            "0.004750 m: the force at the hand ripples; give at least 81");
  EXPECT_TRUE(warningsOf("{nodes: 81}").empty());
  EXPECT_EQ(warningsOf("{nodes: 100}", "solver: {guide_length: 0.01}").size(), 1U);
}

TEST(SceneSchema, LongEdgesOfAdaptiveSamplingGiveAWarningToo)
{
  const std::vector<std::string> warnings = warningsOf("{kind: adaptive, max_edge: 5.0e-3}");
  ASSERT_EQ(warnings.size(), 1U);
  EXPECT_NE(warnings[0].find("sampling.max_edge"), std::string::npos);
  EXPECT_NE(warnings[0].find("give at most that"), std::string::npos);
  EXPECT_TRUE(warningsOf("{kind: adaptive, max_edge: 4.75e-3}").empty());
}

TEST(SceneSchema, LongEdgesWithoutAnIntroducerGiveNoWarning)
{
  EXPECT_TRUE(warningsOf("{nodes: 20}", "introducer: false\nproximal_end: clamped").empty());
}

}  // namespace endovascular_sim::scene
