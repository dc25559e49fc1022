#include "nodes/expert/expert_course.h"

#include <stdexcept>

#include <gtest/gtest.h>

namespace endovascular_sim::nodes
{
namespace
{

/** Expert that pushes 10 mm in step 1 (1 s), turns in step 2 (1 s), and pulls back in step 3 (1 s). */
ExpertCourse pushTurnPull()
{
  std::vector<RunMoment> moments;
  for (int k = 0; k <= 30; ++k)
  {
    const double time = 5.0 + 0.1 * k;
    const double insertion = k <= 10 ? 1e-3 * k : k <= 20 ? 10e-3 : 1e-3 * (30 - k);
    moments.push_back({time, {insertion, 0.0}, k < 10 ? 1U : k < 20 ? 2U : 3U});
  }
  return ExpertCourse(std::move(moments));
}

RunMoment trainee(double time, double insertion, std::size_t step)
{
  return {time, {insertion, 0.0}, step};
}

TEST(AlignedExpert, ByTheStartHasTheSameTimeSinceTheBeginning)
{
  const ExpertCourse expert = pushTurnPull();
  EXPECT_EQ(expert.momentOf(ExpertAlignment::kStart, trainee(102.05, 0.0, 1), 100.0, 100.0), 20U);
  EXPECT_EQ(expert.momentOf(ExpertAlignment::kStart, trainee(99.0, 0.0, 1), 100.0, 100.0), 0U);
  EXPECT_EQ(expert.momentOf(ExpertAlignment::kStart, trainee(200.0, 0.0, 1), 100.0, 100.0), 30U);
}

TEST(AlignedExpert, ByThePhaseBeginsEachStepWithTheTraineeAndWaitsAtItsEnd)
{
  const ExpertCourse expert = pushTurnPull();
  EXPECT_EQ(expert.momentOf(ExpertAlignment::kPhase, trainee(150.25, 0.0, 2), 100.0, 150.0), 12U);
  EXPECT_EQ(expert.momentOf(ExpertAlignment::kPhase, trainee(190.0, 0.0, 2), 100.0, 150.0), 19U);
  EXPECT_EQ(expert.momentOf(ExpertAlignment::kPhase, trainee(190.0, 0.0, 3), 100.0, 190.0), 20U);
  EXPECT_EQ(expert.momentOf(ExpertAlignment::kPhase, trainee(100.3, 0.0, 0), 100.0, 0.0), 3U);
  EXPECT_EQ(expert.momentOf(ExpertAlignment::kPhase, trainee(190.0, 0.0, 9), 100.0, 190.0), 30U);
}

TEST(AlignedExpert, ByTheInsertionStandsWhereTheInstrumentIsInsertedAsFarInTheSameStep)
{
  const ExpertCourse expert = pushTurnPull();
  EXPECT_EQ(expert.momentOf(ExpertAlignment::kInsertion, trainee(1.0, 4.1e-3, 1), 0.0, 0.0), 4U);
  EXPECT_EQ(expert.momentOf(ExpertAlignment::kInsertion, trainee(1.0, 4.1e-3, 3), 0.0, 0.0), 26U);
  EXPECT_EQ(expert.momentOf(ExpertAlignment::kInsertion, trainee(1.0, 0.5, 2), 0.0, 0.0), 19U);
}

TEST(AlignedExpert, ByTheInsertionComparesAllInstruments)
{
  const ExpertCourse expert({{0.0, {0.0, 0.0}, 0}, {1.0, {0.01, 0.0}, 0}, {2.0, {0.01, 0.02}, 0}});
  EXPECT_EQ(expert.momentOf(ExpertAlignment::kInsertion, {0.0, {0.01, 0.019}, 0}, 0.0, 0.0), 2U);
  EXPECT_EQ(expert.momentOf(ExpertAlignment::kInsertion, {0.0, {0.01, 0.001}, 0}, 0.0, 0.0), 1U);
}

TEST(AlignedExpert, NeedsMomentsInTheOrderOfTheirTimes)
{
  EXPECT_THROW(ExpertCourse({}), std::invalid_argument);
  EXPECT_THROW(ExpertCourse({{1.0, {}, 0}, {0.0, {}, 0}}), std::invalid_argument);
}

}  // namespace
}  // namespace endovascular_sim::nodes
