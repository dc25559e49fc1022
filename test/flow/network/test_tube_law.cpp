#include "flow/network/tube_law.h"

#include <cmath>

#include <gtest/gtest.h>

namespace endovascular_sim::flow
{
namespace
{

TEST(TubeLaw, HasTheDerivativeOfItsArea)
{
  const TubeLaw law{1e-5, 4e4};
  for (double excess = -1.2e5; excess < 4e4; excess += 1234.5)
  {
    constexpr double kDifference = 0.5;
    const double difference = (law.areaAt(excess + kDifference) - law.areaAt(excess - kDifference)) / (2 * kDifference);
    EXPECT_NEAR(law.complianceAt(excess) / difference, 1.0, 1e-5) << excess;
  }
}

TEST(TubeLaw, IsPositiveAndContinuousWhereTheVesselCollapses)
{
  const TubeLaw law{1e-5, 4e4};
  const double collapse = (TubeLaw::kCollapse - 1.0) * law.stiffness;
  EXPECT_NEAR(law.areaAt(collapse - 1e-6) / law.areaAt(collapse + 1e-6), 1.0, 1e-9);
  EXPECT_NEAR(law.complianceAt(collapse - 1e-6) / law.complianceAt(collapse + 1e-6), 1.0, 1e-9);
  EXPECT_GT(law.areaAt(-1e6), 0.0);
  EXPECT_LT(law.areaAt(-1e6), law.areaAt(-1e5));
}

TEST(TubeLaw, HasTheWaveSpeedOfMoensAndKorteweg)
{
  // c² = 2Eh/(3ρr) with Poisson's ratio 1/2: β = (4/3)Eh/r.
  const double modulus_thickness = 700e3 * 0.24e-3, radius = 2.6485e-3, density = 1060.0;
  const TubeLaw law{3.14159265358979 * radius * radius, 4.0 / 3.0 * modulus_thickness / radius};
  EXPECT_NEAR(law.waveSpeed(0.0, density), std::sqrt(2.0 * modulus_thickness / (3.0 * density * radius)), 1e-9);
}

}  // namespace
}  // namespace endovascular_sim::flow
