#include "fluoroscopy/gantry/view.h"

#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "common/units.h"

namespace endovascular_sim::fluoroscopy
{
namespace
{

using units::kDegree;

void expectView(const std::string& text, double primary, double secondary)
{
  const std::optional<View> view = parseView(text);
  ASSERT_TRUE(view) << text;
  EXPECT_NEAR(view->primary_angle, primary * kDegree, 1e-15) << text;
  EXPECT_NEAR(view->secondary_angle, secondary * kDegree, 1e-15) << text;
}

TEST(View, KnowsTheNamedViews)
{
  expectView("AP", 0, 0);
  expectView("lateral", 90, 0);
  expectView("spider", 45, -30);
}

TEST(View, ReadsAnyCombinationOfTwoAngles)
{
  expectView("LAO 40", 40, 0);
  expectView("RAO 30", -30, 0);
  expectView("CRA 25", 0, 25);
  expectView("CAU 15", 0, -15);
  expectView("RAO 30 CAU 20", -30, -20);
  expectView("LAO 45 CRA 25", 45, 25);
  expectView("AP CRA 30", 0, 30);
  expectView("LAO 0", 0, 0);
  expectView("RAO 7.5 CRA 40", -7.5, 40);
}

TEST(View, IgnoresCaseAndSpaces)
{
  expectView("lao45cra25", 45, 25);
  expectView("  Rao 30\tcau  20 ", -30, -20);
  expectView("Spider", 45, -30);
}

TEST(View, RefusesOtherTexts)
{
  for (const std::string text : {"",
                                 " ",
                                 "APP",
                                 "LAO",
                                 "LAO x",
                                 "LAO -40",
                                 "40 LAO",
                                 "LAO 40 RAO 20",
                                 "LAO 40 LAO 20",
                                 "CRA 20 LAO 40",
                                 "CRA 20 CAU 10",
                                 "LAO 181",
                                 "CRA 91",
                                 "LAO nan",
                                 "LAO inf",
                                 "LAO 1e1",
                                 "LAO 40 CRA",
                                 "spider CAU 10",
                                 "LAO 40°",
                                 "AP AP",
                                 "AP LAO 10"})
    EXPECT_FALSE(parseView(text)) << text;
}

TEST(View, AnUnknownOneGetsTheListOfKnownOnes)
{
  const std::string text = unknownView("sipder");
  for (const std::string part : {"'sipder'", "AP", "lateral", "spider", "'RAO 30 CAU 20'"})
    EXPECT_NE(text.find(part), std::string::npos) << text;
}

}  // namespace
}  // namespace endovascular_sim::fluoroscopy
