#include "visualization/instrument_tubes.h"

#include <limits>

#include <gtest/gtest.h>

namespace endovascular_sim::visualization
{
namespace
{

/** A wire of radius 0.2 mm, 50 mm inserted, in a catheter of radius 1 mm. */
struct Fixture
{
  WireState state;
  std::vector<InstrumentShape> shapes{{"wire", false, {0.02, 1.0}, {1e-4, 2e-4}}, {"catheter", true, {1.0}, {1e-3}}};
  WireStyle style;
  std::vector<TubeAxis> axes;

  explicit Fixture(double catheter_insertion)
  {
    for (int i = 0; i <= 50; ++i)
    {
      const double arc = 1e-3 * i;
      state.nodes.emplace_back(0.0, 0.0, arc);
      state.radii.push_back(arc <= catheter_insertion ? 1e-3 : 2e-4);
      state.forces.push_back(0.0);
    }
    state.insertions = {0.05, catheter_insertion};
    style.colours = {{0.1F, 0.2F, 0.3F}, {0.9F, 0.8F, 0.7F}};
    style.radius_scale = 2.0;
  }

  void draw()
  {
    ASSERT_EQ(problemOfWire(state, shapes), nullptr);
    instrumentAxes(state, shapes, style, axes);
  }
};

TEST(InstrumentTubes, EndAtTheTipOfEachInstrument)
{
  Fixture fixture(0.0205);
  fixture.draw();
  ASSERT_EQ(fixture.axes.size(), 2U);
  EXPECT_NEAR(fixture.axes[0].points.back().z(), 0.05, 1e-12);
  EXPECT_NEAR(fixture.axes[1].points.back().z(), 0.0205, 1e-12);
}

TEST(InstrumentTubes, HaveTheTrueRadiusTimesTheScaleAlsoInsideAnotherInstrument)
{
  Fixture fixture(0.0205);
  fixture.draw();
  EXPECT_DOUBLE_EQ(fixture.axes[0].radii.front(), 2.0 * 2e-4);  // in the catheter
  EXPECT_DOUBLE_EQ(fixture.axes[1].radii.front(), 2.0 * 1e-3);
}

TEST(InstrumentTubes, AreNotThinnerThanTheSmallestRadiusAndStayInsideOneAnother)
{
  Fixture fixture(0.0205);
  fixture.style.smallest_radius = 4e-3;
  fixture.draw();
  EXPECT_DOUBLE_EQ(fixture.axes[1].radii.front(), 4e-3);
  EXPECT_DOUBLE_EQ(fixture.axes[0].radii.front(), 4.0 * 2e-4);  // in the catheter
  EXPECT_DOUBLE_EQ(fixture.axes[0].radii[40], 4e-3);
}

TEST(InstrumentTubes, AreTranslucentOnlyOverAnotherInstrument)
{
  Fixture fixture(0.05);
  fixture.state.insertions = {0.03, 0.05};
  fixture.draw();
  EXPECT_EQ(fixture.axes[1].colours.front().opacity, 0.35F);
  EXPECT_EQ(fixture.axes[1].colours.back().opacity, 1.0F);
  EXPECT_EQ(fixture.axes[0].colours.front().opacity, 1.0F);
}

TEST(InstrumentTubes, ShowForcesOnTheOutermostSurfaceOnly)
{
  Fixture fixture(0.0205);
  fixture.state.forces[10] = 1.0;
  fixture.draw();
  const Colour red = forceColour(1.0, fixture.style.full_force);
  EXPECT_EQ(fixture.axes[1].colours[10].colour.red, red.red);
  EXPECT_EQ(fixture.axes[1].colours[10].colour.green, red.green);
  EXPECT_EQ(fixture.axes[0].colours[10].colour.green, 0.2F);  // the wire keeps the colour of its instrument
  fixture.style.shows_forces = false;
  fixture.draw();
  EXPECT_EQ(fixture.axes[1].colours[10].colour.green, 0.8F);
}

TEST(InstrumentTubes, WithoutShapesAreOneTubeOfTheOuterRadius)
{
  Fixture fixture(0.0205);
  fixture.shapes.clear();
  fixture.draw();
  ASSERT_EQ(fixture.axes.size(), 1U);
  EXPECT_DOUBLE_EQ(fixture.axes[0].radii.front(), 2e-3);
  EXPECT_DOUBLE_EQ(fixture.axes[0].radii.back(), 4e-4);
}

TEST(InstrumentTubes, OfAnInstrumentOutsideOfTheIntroducerAreEmpty)
{
  Fixture fixture(0.0);
  fixture.state.insertions[1] = -0.01;
  fixture.draw();
  EXPECT_TRUE(fixture.axes[1].points.empty());
}

TEST(ProblemOfWire, NamesInconsistentAndInvalidStates)
{
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const Fixture valid(0.02);
  Fixture state = valid;
  state.state.forces.pop_back();
  EXPECT_STREQ(problemOfWire(state.state, state.shapes), "inconsistent lengths");
  state = valid;
  state.state.forces[3] = nan;
  EXPECT_STREQ(problemOfWire(state.state, state.shapes), "not finite");
  state = valid;
  state.state.insertions = {0.05};
  EXPECT_STREQ(problemOfWire(state.state, state.shapes), "insertions do not match the instruments of the scene");
  state = valid;
  state.state.nodes[7].x() = nan;
  EXPECT_STREQ(problemOfWire(state.state, state.shapes), "not finite");
  EXPECT_STREQ(problemOfWire({}, {}), "empty");
}

TEST(ForceColourOver, BeginsWithTheColourOfTheInstrumentAndIsContinuous)
{
  const Colour base{0.1F, 0.2F, 0.3F};
  EXPECT_EQ(forceColourOver(base, 0.0, 0.3).green, 0.2F);
  EXPECT_NEAR(forceColourOver(base, 0.1 - 1e-9, 0.3).green, forceColour(0.1, 0.3).green, 1e-5F);
  EXPECT_NEAR(forceColourOver(base, 0.1 + 1e-9, 0.3).green, forceColour(0.1, 0.3).green, 1e-5F);
  EXPECT_EQ(forceColourOver(base, 5.0, 0.3).red, forceColour(0.3, 0.3).red);
}

}  // namespace
}  // namespace endovascular_sim::visualization
