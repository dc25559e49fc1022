#include "sensor/sensor_channel.h"

#include <cmath>

#include <gtest/gtest.h>

#include "common/archive.h"

namespace endovascular_sim::sensor
{
namespace
{

constexpr double kStep = 1e-3;  // s
constexpr std::uint64_t kSamples = 100000;

SensorSettings encoder()
{
  SensorSettings settings;
  settings.name = "encoder";
  settings.kind = SensorKind::kEncoder;
  return settings;
}

/** Measures the step number and its negative. */
SensorChannel::Measure stepNumber(std::uint64_t step)
{
  return [step](const Errors& errors, std::vector<double>& values)
  {
    values = {static_cast<double>(step) + errors[0], -static_cast<double>(step) + errors[1]};
    return true;
  };
}

/** Measures zeros. */
bool zeros(const Errors& errors, std::vector<double>& values)
{
  values = {errors[0], errors[1]};
  return true;
}

struct Moments
{
  double mean = 0.0;
  double deviation = 0.0;
  double skewness = 0.0;
  double kurtosis = 0.0;
};

Moments momentsOf(const std::vector<double>& values)
{
  Moments moments;
  for (const double value : values)
    moments.mean += value / static_cast<double>(values.size());
  double second = 0.0;
  double third = 0.0;
  double fourth = 0.0;
  for (const double value : values)
  {
    const double d = value - moments.mean;
    second += d * d / static_cast<double>(values.size());
    third += d * d * d / static_cast<double>(values.size());
    fourth += d * d * d * d / static_cast<double>(values.size());
  }
  moments.deviation = std::sqrt(second);
  moments.skewness = third / std::pow(second, 1.5);
  moments.kurtosis = fourth / (second * second);
  return moments;
}

double correlation(const std::vector<double>& a, const std::vector<double>& b, std::size_t shift = 0)
{
  const Moments of_a = momentsOf(a);
  const Moments of_b = momentsOf(b);
  double sum = 0.0;
  for (std::size_t k = 0; k + shift < a.size(); ++k)
    sum += (a[k] - of_a.mean) * (b[k + shift] - of_b.mean);
  return sum / (static_cast<double>(a.size() - shift) * of_a.deviation * of_b.deviation);
}

// Bounds are five standard errors of the estimates.
TEST(SensorChannel, NoiseHasTheMeanAndTheStandardDeviationOfItsSettings)
{
  SensorSettings settings = encoder();
  settings.noise = {2e-3, 0.5};
  settings.bias = {1e-3, -0.2};
  SensorChannel channel(settings, kStep, 0);
  std::vector<double> a, b;
  for (std::uint64_t step = 1; step <= kSamples; ++step)
  {
    ASSERT_TRUE(channel.update(step, zeros));
    a.push_back(channel.reading().values[0]);
    b.push_back(channel.reading().values[1]);
  }
  const double root = std::sqrt(static_cast<double>(kSamples));
  for (const auto& [values, k] : {std::pair(a, 0), std::pair(b, 1)})
  {
    const Moments moments = momentsOf(values);
    EXPECT_NEAR(moments.mean, settings.bias[k], 5.0 * settings.noise[k] / root);
    EXPECT_NEAR(moments.deviation, settings.noise[k], 5.0 * settings.noise[k] / (std::sqrt(2.0) * root));
    EXPECT_NEAR(moments.skewness, 0.0, 5.0 * std::sqrt(6.0) / root);
    EXPECT_NEAR(moments.kurtosis, 3.0, 5.0 * std::sqrt(24.0) / root);
    for (const std::size_t shift : {1U, 2U, 7U})
      EXPECT_NEAR(correlation(values, values, shift), 0.0, 5.0 / root);
  }
  EXPECT_NEAR(correlation(a, b), 0.0, 5.0 / root);
}

TEST(SensorChannel, SamplesAreLostWithTheProbabilityOfTheirSettings)
{
  SensorSettings settings = encoder();
  settings.drop_out = 0.05;
  settings.noise[0] = 1.0;
  SensorChannel channel(settings, kStep, 0);
  std::vector<double> lost;
  for (std::uint64_t step = 1; step <= kSamples; ++step)
  {
    ASSERT_TRUE(channel.update(step, zeros));
    lost.push_back(channel.reading().valid ? 0.0 : 1.0);
  }
  const double root = std::sqrt(static_cast<double>(kSamples));
  EXPECT_NEAR(momentsOf(lost).mean, 0.05, 5.0 * std::sqrt(0.05 * 0.95) / root);
  EXPECT_NEAR(correlation(lost, lost, 1), 0.0, 5.0 / root);
}

TEST(SensorChannel, ALostSampleKeepsTheValuesOfTheOneBefore)
{
  SensorSettings settings = encoder();
  settings.drop_out = 0.5;
  SensorChannel channel(settings, kStep, 0);
  double newest = 0.0;
  int lost = 0;
  for (std::uint64_t step = 1; step <= 1000; ++step)
  {
    channel.update(step, stepNumber(step));
    EXPECT_EQ(channel.reading().sequence, step);
    newest = channel.reading().valid ? static_cast<double>(step) : newest;
    lost += channel.reading().valid ? 0 : 1;
    EXPECT_EQ(channel.reading().values[0], newest);
  }
  EXPECT_GT(lost, 400);
}

TEST(SensorChannel, EverySampleIsDeliveredAfterTheDelay)
{
  for (const double delay : {0.0, 1e-3, 17e-3, 0.25})
  {
    SensorSettings settings = encoder();
    settings.delay = delay;
    SensorChannel channel(settings, kStep, 0);
    const auto steps = static_cast<std::uint64_t>(std::lround(delay / kStep));
    for (std::uint64_t step = 1; step <= kSamples; ++step)
    {
      ASSERT_EQ(channel.update(step, stepNumber(step)), step > steps) << step;
      if (step <= steps)
      {
        ASSERT_EQ(channel.reading().sequence, 0U);
        ASSERT_FALSE(channel.reading().valid);
        continue;
      }
      ASSERT_EQ(channel.reading().step, step - steps);
      ASSERT_EQ(channel.reading().values[0], static_cast<double>(step - steps));
    }
  }
}

TEST(SensorChannel, SamplesComeAtTheirRateAlsoWhereItDividesNoStep)
{
  for (const double rate : {1.0, 40.0, 60.0, 333.0, 1000.0})
  {
    SensorSettings settings = encoder();
    settings.rate = rate;
    SensorChannel channel(settings, kStep, 0);
    std::uint64_t samples = 0;
    for (std::uint64_t step = 1; step <= kSamples; ++step)
      if (channel.update(step, stepNumber(step)))
      {
        ++samples;
        ASSERT_EQ(channel.reading().sequence, samples);
        const double due = static_cast<double>(samples) / rate;
        ASSERT_GE(static_cast<double>(step) * kStep, due - 1e-6);
        ASSERT_LT(static_cast<double>(step - 1) * kStep, due);
      }
    EXPECT_EQ(samples, static_cast<std::uint64_t>(std::lround(1e-3 * rate * kSamples)));
  }
}

TEST(SensorChannel, EqualSeedsGiveEqualBitsAndOthersDoNot)
{
  SensorSettings settings = encoder();
  settings.noise = {1.0, 1.0};
  SensorSettings renamed = settings;
  renamed.name = "other";
  SensorSettings reseeded = settings;
  reseeded.seed = 1;
  SensorChannel first(settings, kStep, 7);
  SensorChannel same(settings, kStep, 7);
  SensorChannel of_seed(settings, kStep, 8);
  SensorChannel of_name(renamed, kStep, 7);
  SensorChannel of_key(reseeded, kStep, 7);
  int equal = 0;
  for (std::uint64_t step = 1; step <= 1000; ++step)
  {
    for (SensorChannel* channel : {&first, &same, &of_seed, &of_name, &of_key})
      channel->update(step, zeros);
    ASSERT_EQ(first.reading().values, same.reading().values);
    for (const SensorChannel* other : {&of_seed, &of_name, &of_key})
      equal += first.reading().values == other->reading().values ? 1 : 0;
  }
  EXPECT_EQ(equal, 0);
}

TEST(SensorChannel, ASavedDelayContinuesBitForBit)
{
  SensorSettings settings = encoder();
  settings.noise = {1.0, 1.0};
  settings.delay = 0.05;
  settings.rate = 333.0;
  settings.drop_out = 0.2;
  SensorChannel channel(settings, kStep, 3);
  for (std::uint64_t step = 1; step <= 120; ++step)
    channel.update(step, stepNumber(step));
  Archive saved;
  saved(channel);
  SensorChannel loaded(settings, kStep, 3);
  Archive reading(saved.bytes());
  reading(loaded);
  EXPECT_TRUE(reading.atEnd());
  for (std::uint64_t step = 121; step <= 400; ++step)
  {
    ASSERT_EQ(channel.update(step, stepNumber(step)), loaded.update(step, stepNumber(step)));
    ASSERT_EQ(channel.reading().values, loaded.reading().values) << step;
    ASSERT_EQ(channel.reading().valid, loaded.reading().valid);
    ASSERT_EQ(channel.reading().sequence, loaded.reading().sequence);
  }
}

TEST(SensorChannel, ASampleWithoutAMeasurementIsInvalid)
{
  SensorChannel channel(encoder(), kStep, 0);
  EXPECT_TRUE(channel.update(1, [](const Errors& /*errors*/, std::vector<double>& /*values*/) { return false; }));
  EXPECT_FALSE(channel.reading().valid);
  EXPECT_EQ(channel.reading().values, std::vector<double>(2, 0.0));
}

TEST(SensorChannel, DamagedSamplesAreRefused)
{
  SensorSettings tracker = encoder();
  tracker.kind = SensorKind::kEmTracker;
  SensorChannel of_tracker(tracker, kStep, 0);
  Archive saved;
  saved(of_tracker);
  SensorChannel of_encoder(encoder(), kStep, 0);
  Archive reading(saved.bytes());
  EXPECT_THROW(reading(of_encoder), ArchiveError);
}

}  // namespace
}  // namespace endovascular_sim::sensor
