#include "contrast/injection/injector.h"

#include <cmath>
#include <stdexcept>

#include <gtest/gtest.h>

#include "common/archive.h"

namespace endovascular_sim::contrast
{
namespace
{

Injection puff()
{
  return {5e-6, 3e-6, 0.3, 350.0, 10.4e-3};
}

TEST(Injector, GivesTheWholeVolumeForEveryTimeStep)
{
  for (const double step : {1e-3, 5e-3, 0.02, 7.0})
  {
    Injector injector(kHandSyringe);
    injector.start(puff());
    double volume = 0.0;
    while (injector.isActive())
    {
      const Dose dose = injector.advance(step);
      EXPECT_GE(dose.volume, 0.0);
      EXPECT_LE(dose.volume, 3e-6 * step * (1.0 + 1e-12));
      EXPECT_EQ(dose.concentration, 350.0);
      volume += dose.volume;
    }
    EXPECT_NEAR(volume, 5e-6, 1e-17) << step;
    EXPECT_NEAR(injector.content(), 7e-6, 1e-17) << step;
    EXPECT_EQ(injector.advance(step).volume, 0.0);
  }
}

TEST(Injector, RefusesMoreThanIsLeftUntilItIsRefilled)
{
  Injector injector(kHandSyringe);
  for (int k = 0; k < 2; ++k)
  {
    injector.start(puff());
    injector.advance(10.0);
  }
  EXPECT_THROW(injector.start(puff()), std::invalid_argument);
  injector.refill();
  EXPECT_NO_THROW(injector.start(puff()));
}

TEST(Injector, KeepsTheRestWhenItIsStopped)
{
  Injector injector(kHandSyringe);
  injector.start(puff());
  const double given = injector.advance(0.8).volume;
  injector.stop();
  EXPECT_FALSE(injector.isActive());
  EXPECT_EQ(injector.advance(1.0).volume, 0.0);
  EXPECT_NEAR(injector.content(), 12e-6 - given, 1e-18);
}

TEST(Injector, ContinuesFromAnArchiveWithEqualBits)
{
  Injector first(kHandSyringe), second(kHandSyringe);
  first.start(puff());
  for (int k = 0; k < 77; ++k)
    first.advance(5e-3);
  Archive written;
  first.archive(written);
  Archive read(written.bytes());
  second.archive(read);
  while (first.isActive())
    ASSERT_EQ(first.advance(5e-3).volume, second.advance(5e-3).volume);
  EXPECT_FALSE(second.isActive());
}

TEST(Injector, RefusesAnArchiveOfMoreThanASyringeHolds)
{
  Injector pump(kPumpSyringe), hand(kHandSyringe);
  Archive written;
  pump.archive(written);
  Archive read(written.bytes());
  EXPECT_THROW(hand.archive(read), ArchiveError);
}

}  // namespace
}  // namespace endovascular_sim::contrast
