#include "fluoroscopy/angiography/pulse_train.h"

#include <gtest/gtest.h>

namespace endovascular_sim::fluoroscopy
{
namespace
{

TEST(PulseTrain, IsAtTheFirstStepAtOrAfterItsTime)
{
  const PulseTrain train(15.0, 1e-3);
  const std::uint64_t steps[] = {0, 67, 134, 200, 267, 334, 400};
  for (std::uint64_t k = 0; k < 7; ++k)
    EXPECT_EQ(train.stepOf(k), steps[k]) << k;
  EXPECT_EQ(train.stepOf(15 * 3600), 3600000U);  // rounding does not add up
  EXPECT_EQ(PulseTrain(30.0, 1e-3).stepOf(2), 67U);
  EXPECT_EQ(PulseTrain(7.5, 5e-4).stepOf(3), 800U);
}

TEST(PulseTrain, FindsTheNewestPulseOfEveryStep)
{
  for (const double rate : {3.0, 7.5, 15.0, 30.0, 60.0})
    for (const double time_step : {1e-3, 5e-4, 2e-3})
    {
      const PulseTrain train(rate, time_step);
      std::uint64_t pulse = 0;
      for (std::uint64_t step = 0; step < 20000; ++step)
      {
        if (train.stepOf(pulse + 1) == step)
          ++pulse;
        ASSERT_EQ(train.newestAt(step), pulse) << rate << " " << step;
        ASSERT_EQ(train.isPulse(step), train.stepOf(pulse) == step) << rate << " " << step;
      }
    }
}

TEST(PulseTrain, GivesAPulseAtEveryStepWhereStepsAreFewer)
{
  const PulseTrain train(1000.0, 2e-3);
  EXPECT_TRUE(train.isPulse(7));
  EXPECT_EQ(train.newestAt(7), 14U);
}

}  // namespace
}  // namespace endovascular_sim::fluoroscopy
