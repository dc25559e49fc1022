#include "benchmark/studies/sampling_study.h"

#include <gtest/gtest.h>

namespace endovascular_sim::benchmark
{
namespace
{

TEST(SamplingStudy, ComparesEverySamplingWithTheReference)
{
  SamplingCase tube = samplingCases("", true).front();
  tube.duration = 2.0;  // the tip is at the centre of the bend
  double done = 0.0;
  const std::vector<SamplingResult> results = studySampling(tube, 1,
                                                            [&done](double share, const std::string& what)
                                                            {
                                                              EXPECT_GE(share, done);
                                                              EXPECT_FALSE(what.empty());
                                                              done = share;
                                                            });
  ASSERT_EQ(results.size(), 5U);
  EXPECT_LT(results[0].rms_distance, 1e-7);
  EXPECT_EQ(results[0].max_tip_error, 0.0);
  EXPECT_EQ(results[0].energy_error, 0.0);
  EXPECT_EQ(results[0].force_error, 0.0);
  // The error grows with the length of the edges.
  EXPECT_GT(results[1].rms_distance, results[0].rms_distance);
  EXPECT_GT(results[2].rms_distance, results[1].rms_distance);
  EXPECT_TRUE(results[3].isAdaptive());
  EXPECT_FALSE(results[4].isAdaptive());
  EXPECT_LT(2.0 * results[3].mean_simulated_nodes, results[1].mean_simulated_nodes);
  EXPECT_NEAR(results[4].mean_simulated_nodes, results[3].mean_simulated_nodes, 0.06 * results[3].mean_simulated_nodes);
  EXPECT_GE(results[3].resampling_jump, 0.0);
  for (const SamplingResult& result : results)
  {
    EXPECT_EQ(result.unsolved, 0);
    EXPECT_GT(result.force_peak, 0.0);
  }
  EXPECT_EQ(judgeSampling(results).size(), 8U);
}

TEST(SamplingStudy, ComparesMeasuresWithTheirLimits)
{
  std::vector<SamplingResult> results(5);
  results[1].rms_distance = 10e-6;
  results[1].step_time = 100e-6;
  results[3].rms_distance = 12e-6;
  results[3].step_time = 50e-6;
  results[3].max_tip_error = 0.3e-3;
  results[4].rms_distance = 20e-6;
  const std::vector<SamplingVerdict> verdicts = judgeSampling(results);
  const auto holds = [&verdicts](const std::string& measure)
  {
    for (const SamplingVerdict& verdict : verdicts)
      if (verdict.measure == measure)
        return verdict.holds();
    ADD_FAILURE() << measure;
    return false;
  };
  EXPECT_FALSE(holds("RMS distance / uniform 0.5 mm"));
  EXPECT_FALSE(holds("largest tip error [m]"));
  EXPECT_TRUE(holds("time / uniform 0.5 mm"));
  EXPECT_TRUE(holds("RMS distance / uniform with as many nodes"));
}

TEST(SamplingStudy, HasAFurtherCaseWithAMesh)
{
  EXPECT_EQ(samplingCases("", false).size(), 2U);
  EXPECT_EQ(samplingCases("/data/aortic_arch_tree.obj", false).size(), 3U);
}

}  // namespace
}  // namespace endovascular_sim::benchmark
