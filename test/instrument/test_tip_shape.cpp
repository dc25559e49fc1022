#include "instrument/tip_shape.h"

#include <gtest/gtest.h>

#include <cmath>
#include <stdexcept>

namespace endovascular_sim::instrument
{
namespace
{

Instrument wireOf(const std::vector<double>& lengths)
{
  Instrument instrument;
  for (std::size_t k = 0; k < lengths.size(); ++k)
  {
    rod::Section section;
    section.length = lengths[k];
    section.bending_stiffness = static_cast<double>(k + 1);
    instrument.wire.sections.push_back(section);
    instrument.materials.push_back(k == 0 ? Material::kSteel : Material::kPlatinum);
  }
  return instrument;
}

/** Total rotation of the tangent: integral of the rest curvature over the length. */
double turn(const Instrument& instrument)
{
  double angle = 0.0;
  for (const rod::Section& section : instrument.wire.sections)
    angle += section.rest_curvature.norm() * section.length;
  return angle;
}

TEST(TipShape, PreservesLengthAndSubtendsItsAngleForAllSectionBoundaries)
{
  for (const double last : {0.001, 0.005, 0.0078539816339744831, 0.01, 0.05})
    for (const double straight : {0.0, 0.001, 0.002})
    {
      Instrument instrument = wireOf({0.1, last});
      applyTipShape(instrument, {0.01, M_PI / 4.0, straight, 0.0});
      EXPECT_NEAR(instrument.wire.length(), 0.1 + last, 1e-15);
      EXPECT_NEAR(turn(instrument), M_PI / 4.0, 1e-9);
      EXPECT_EQ(instrument.materials.size(), instrument.wire.sections.size());
      EXPECT_NEAR(instrument.wire.curvedTipLength(), 0.01 * M_PI / 4.0 + straight, 1e-9);
    }
}

TEST(TipShape, PreservesThePropertiesOfSplitSections)
{
  Instrument instrument = wireOf({0.1, 0.004});
  applyTipShape(instrument, {0.01, 1.0, 0.0, 0.0});
  ASSERT_EQ(instrument.wire.sections.size(), 3U);
  EXPECT_EQ(instrument.wire.sections[1].bending_stiffness, 1.0);
  EXPECT_EQ(instrument.wire.sections[2].bending_stiffness, 2.0);
  EXPECT_EQ(instrument.materials[1], Material::kSteel);
  EXPECT_EQ(instrument.materials[2], Material::kPlatinum);
}

TEST(TipShape, DirectionIsThatOfTheCurvatureVectorInTheMaterialFrame)
{
  // κb = ω₁ d2 − ω₂ d1.
  for (const double direction : {0.0, 0.7, -2.0})
  {
    const Eigen::Vector2d omega = arcCurvature(0.02, direction);
    EXPECT_NEAR(-omega.y(), 50.0 * std::cos(direction), 1e-12);
    EXPECT_NEAR(omega.x(), 50.0 * std::sin(direction), 1e-12);
  }
}

TEST(TipShape, MayCoverTheWholeWireButNotMore)
{
  Instrument whole = wireOf({0.01});
  applyTipShape(whole, {0.01, 1.0, 0.0, 0.0});
  EXPECT_EQ(whole.wire.sections.size(), 1U);
  Instrument shorter = wireOf({0.009});
  EXPECT_THROW(applyTipShape(shorter, {0.01, 1.0, 0.0, 0.0}), std::invalid_argument);
}

TEST(TipShape, RejectsASecondBend)
{
  Instrument instrument = wireOf({0.1});
  applyTipShape(instrument, {0.01, 1.0, 0.0, 0.0});
  EXPECT_THROW(applyTipShape(instrument, {0.01, 0.5, 0.0, 0.0}), std::invalid_argument);
}

}  // namespace
}  // namespace endovascular_sim::instrument
