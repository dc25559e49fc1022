#include "instrument/instrument.h"

#include <gtest/gtest.h>

namespace endovascular_sim::instrument
{
namespace
{

Instrument tube(double radius, double inner_radius)
{
  Instrument instrument;
  instrument.wire.sections.resize(2);
  instrument.wire.sections[0].radius = radius;
  instrument.wire.sections[1].radius = 0.5 * radius;
  instrument.inner_radius = inner_radius;
  return instrument;
}

TEST(Instrument, FitsIfItsLargestRadiusIsBelowTheLumenRadius)
{
  const Instrument catheter = tube(1.0e-3, 0.6e-3);
  EXPECT_TRUE(fitsInside(tube(0.59e-3, 0.0), catheter));
  EXPECT_FALSE(fitsInside(tube(0.6e-3, 0.0), catheter));
  EXPECT_FALSE(fitsInside(tube(0.1e-3, 0.0), tube(1.0e-3, 0.0)));
}

TEST(Instrument, IncludesBalloonAndStentInTheCrossingProfile)
{
  Instrument balloon = tube(0.4e-3, 0.2e-3);
  EXPECT_EQ(crossingRadius(balloon), 0.4e-3);
  balloon.balloon.emplace().folded_diameter = 0.9e-3;
  EXPECT_EQ(crossingRadius(balloon), 0.45e-3);
  balloon.stent.emplace().crimped_diameter = 1.1e-3;
  EXPECT_EQ(crossingRadius(balloon), 0.55e-3);
}

}  // namespace
}  // namespace endovascular_sim::instrument
