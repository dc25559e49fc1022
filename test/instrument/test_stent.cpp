#include "instrument/stent.h"

#include <gtest/gtest.h>

namespace endovascular_sim::instrument
{
namespace
{

TEST(Stent, ShortensOnExpansionWithConstantLengthOutsideTheTable)
{
  Stent stent;
  stent.expansion = {{0.9e-3, 18.2e-3}, {3.0e-3, 18.0e-3}, {3.7e-3, 17.6e-3}};
  EXPECT_EQ(stent.lengthAt(0.5e-3), 18.2e-3);
  EXPECT_NEAR(stent.lengthAt(1.95e-3), 18.1e-3, 1e-15);
  EXPECT_EQ(stent.lengthAt(3.0e-3), 18.0e-3);
  EXPECT_NEAR(stent.lengthAt(3.35e-3), 17.8e-3, 1e-15);
  EXPECT_EQ(stent.lengthAt(4.0e-3), 17.6e-3);
  EXPECT_EQ(stent.crimpedLength(), 18.2e-3);
  EXPECT_EQ(stent.largestDiameter(), 3.7e-3);
}

TEST(Stent, RecoilsByItsFractionOfTheDiameter)
{
  Stent stent;
  stent.recoil = 0.045;
  EXPECT_NEAR(stent.afterRecoil(3.0e-3), 2.865e-3, 1e-15);
}

}  // namespace
}  // namespace endovascular_sim::instrument
