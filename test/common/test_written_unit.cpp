#include "common/written_unit.h"

#include <cmath>

#include <gtest/gtest.h>

#include "common/quantities.h"
#include "common/units.h"

namespace endovascular_sim
{
namespace
{

/** Value of a unit; NaN for text that is no unit of the quantity. */
double valueOf(const Quantity& quantity, const std::string& unit)
{
  return unitValue(quantity, unit).value_or(std::nan(""));
}

TEST(WrittenUnit, OfDataSheetsHaveTheirValueInSi)
{
  EXPECT_DOUBLE_EQ(valueOf(quantities::kWireDiameter, "F"), 1e-3 / 3.0);
  EXPECT_DOUBLE_EQ(valueOf(quantities::kWireDiameter, "Fr"), 1e-3 / 3.0);
  EXPECT_DOUBLE_EQ(valueOf(quantities::kWireDiameter, "in"), 0.0254);
  EXPECT_DOUBLE_EQ(valueOf(quantities::kWireDiameter, "\""), 0.0254);
  EXPECT_DOUBLE_EQ(valueOf(quantities::kSectionLength, "mm"), 1e-3);
  EXPECT_DOUBLE_EQ(valueOf(quantities::kSectionLength, "µm"), 1e-6);
  EXPECT_DOUBLE_EQ(valueOf(quantities::kPointForce, "gf"), 9.80665e-3);
  EXPECT_DOUBLE_EQ(valueOf(quantities::kPointForce, "mN"), 1e-3);
  EXPECT_DOUBLE_EQ(valueOf(quantities::kPointForce, "N"), 1.0);
  EXPECT_DOUBLE_EQ(valueOf(quantities::kModulus, "GPa"), 1e9);
  EXPECT_DOUBLE_EQ(valueOf(quantities::kModulus, "MPa"), 1e6);
  EXPECT_DOUBLE_EQ(valueOf(quantities::kModulus, "N/mm²"), 1e6);
  EXPECT_DOUBLE_EQ(valueOf(quantities::kModulus, "psi"), 6894.757);
  EXPECT_DOUBLE_EQ(valueOf(quantities::kPressure, "atm"), 101325.0);
  EXPECT_DOUBLE_EQ(valueOf(quantities::kPressure, "bar"), 1e5);
  EXPECT_DOUBLE_EQ(valueOf(quantities::kDensity, "g/cm3"), 1e3);
  EXPECT_DOUBLE_EQ(valueOf(quantities::kAngle, "deg"), units::kDegree);
  EXPECT_DOUBLE_EQ(valueOf(quantities::kPointTorque, "mN·m"), 1e-3);
  EXPECT_DOUBLE_EQ(valueOf(quantities::kFriction, "%"), 1e-2);
}

TEST(WrittenUnit, IsTheSameWithoutSpecialCharacters)
{
  for (const char* spelling : {"N·mm²", "N.mm2", "Nmm2", "N*mm^2", "N mm²"})
    EXPECT_DOUBLE_EQ(valueOf(quantities::kFlexuralRigidity, spelling), 1e-6) << spelling;
}

TEST(WrittenUnit, OfAnotherDimensionIsRefusedWithItsDimensionAndTheRightUnits)
{
  EXPECT_FALSE(unitValue(quantities::kModulus, "mm"));
  EXPECT_EQ(unitRemedy(quantities::kModulus, "mm").rfind("mm is a unit of length; moduli are in Pa, GPa, MPa", 0), 0U)
      << unitRemedy(quantities::kModulus, "mm");
  EXPECT_EQ(unitRemedy(quantities::kSectionLength, "N").rfind("N is a unit of force; section lengths are in m, mm", 0),
            0U)
      << unitRemedy(quantities::kSectionLength, "N");
  EXPECT_EQ(unitRemedy(quantities::kDuration, "parsec").rfind("\"parsec\" is no known unit; durations are in s", 0), 0U)
      << unitRemedy(quantities::kDuration, "parsec");
  EXPECT_EQ(unitRemedy(quantities::kNumber, "m"), "m is a unit of length; numbers have no unit: give a number");
}

TEST(WrittenUnit, OfASizeIsRefusedForARadius)
{
  EXPECT_FALSE(unitValue(quantities::kWireRadius, "F"));
  EXPECT_FALSE(unitValue(quantities::kWireRadius, "in"));
  EXPECT_TRUE(unitValue(quantities::kWireRadius, "mm"));
  EXPECT_NE(unitRemedy(quantities::kWireRadius, "F").find("by the key of the diameter"), std::string::npos);
  EXPECT_EQ(unitRemedy(quantities::kWireRadius, "F").rfind("F is a unit of diameter", 0), 0U);
}

TEST(WrittenUnit, OfMassIsNoForce)
{
  EXPECT_FALSE(unitValue(quantities::kPointForce, "g"));
  EXPECT_NE(unitRemedy(quantities::kPointForce, "g").find("as gf"), std::string::npos);
}

}  // namespace
}  // namespace endovascular_sim
