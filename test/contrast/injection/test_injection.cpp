#include "contrast/injection/injection.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <gtest/gtest.h>

namespace endovascular_sim::contrast
{
namespace
{

/** Hand injection into a left coronary artery. */
Injection puff()
{
  return {8e-6, 4e-6, 0.2, 350.0, 10.4e-3};
}

TEST(Injection, GivesTheIntegralOfARateThatRisesLinearly)
{
  const Injection injection = puff();
  double volume = 0.0;
  constexpr double kStep = 1e-4;
  for (int k = 0; k < 30000; ++k)
  {
    const double time = (k + 0.5) * kStep;
    volume += kStep * injection.rate * std::min(1.0, time / injection.rise);
    ASSERT_NEAR(injection.volumeAfter((k + 1) * kStep), std::min(volume, injection.volume), 1e-6 * injection.volume);
  }
  EXPECT_NEAR(injection.duration(), 2.1, 1e-12);
  EXPECT_LT(injection.volumeAfter(0.999 * injection.duration()), injection.volume);
  EXPECT_NEAR(injection.volumeAfter(injection.duration()), injection.volume, 1e-15);
}

TEST(Injection, CanEndWhileItsRateRises)
{
  const Injection injection{1e-6, 4e-6, 1.0, 350.0, 10.4e-3};
  EXPECT_NEAR(injection.duration(), std::sqrt(0.5), 1e-12);
  EXPECT_NEAR(injection.volumeAfter(0.5), 0.5e-6, 1e-18);
  EXPECT_EQ(injection.volumeAfter(2.0), injection.volume);
}

TEST(Injection, IsAcceptedAsOperatorsAndPumpsGiveIt)
{
  EXPECT_EQ(refusalOf(puff(), kHandSyringe), "");
  EXPECT_EQ(refusalOf({30e-6, 15e-6, 0.3, 350.0, 10.4e-3}, kPumpSyringe), "");
  EXPECT_EQ(refusalOf({12e-6, 10e-6, 0.0, 400.0, 12.6e-3}, kHandSyringe), "");
}

TEST(Injection, IsRefusedWithTheRemedyWhereNoSyringeGivesIt)
{
  const auto refused = [](auto change, const char* words, const Syringe& syringe = kHandSyringe)
  {
    Injection injection = puff();
    change(injection);
    const std::string refusal = refusalOf(injection, syringe);
    EXPECT_NE(refusal.find(words), std::string::npos) << refusal << ", expected: " << words;
  };
  const double nan = std::nan(""), infinity = std::numeric_limits<double>::infinity();
  for (const double value : {0.0, -1e-6, nan, infinity})
  {
    refused([&](Injection& i) { i.volume = value; }, "volume");
    refused([&](Injection& i) { i.rate = value; }, "rate");
    refused([&](Injection& i) { i.concentration = value; }, "concentration");
    refused([&](Injection& i) { i.viscosity = value; }, "viscosity");
  }
  for (const double value : {-0.1, nan, infinity, 11.0})
    refused([&](Injection& i) { i.rise = value; }, "rise");
  refused([](Injection& i) { i.volume = 12.1e-6; }, "the hand syringe holds 12 ml; inject less");
  refused([](Injection& i) { i.volume = 151e-6; }, "the pump holds 150 ml", kPumpSyringe);
  refused([](Injection& i) { i.rate = 10.1e-6; }, "at most 10 ml/s");
  refused([](Injection& i) { i.rate = 41e-6; }, "at most 40 ml/s", kPumpSyringe);
  refused([](Injection& i) { i.concentration = 401.0; }, "at most 400");
  refused([](Injection& i) { i.viscosity = 10.4; }, "e.g. 0.0104");
  EXPECT_NE(refusalOf(puff(), kHandSyringe, 7e-6).find("holds 7 ml"), std::string::npos);
}

}  // namespace
}  // namespace endovascular_sim::contrast
