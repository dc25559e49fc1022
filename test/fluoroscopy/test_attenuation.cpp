#include "fluoroscopy/attenuation.h"

#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <string>

#include "common/error.h"

namespace endovascular_sim::fluoroscopy
{
namespace
{

const std::string kTable = PROJECT_DIR "/config/xray/attenuation.yaml";

TEST(AttenuationTable, ReproducesKnownTransmissionsAt60keV)
{
  const AttenuationTable table = AttenuationTable::load(kTable);
  const double blood = table.linear("blood", 60.0);
  const auto vessel = [&](double iodine) { return std::exp(-(table.contrast(iodine, 60.0) - blood) * 4e-3); };
  EXPECT_NEAR(vessel(300.0), 0.403, 5e-4);
  EXPECT_NEAR(vessel(150.0), 0.635, 5e-4);
  EXPECT_NEAR(vessel(50.0), 0.859, 5e-4);
  EXPECT_NEAR(std::exp(-table.contrast(300.0, 60.0) * 4e-3), 0.37, 5e-3);
  EXPECT_NEAR(std::exp(-(table.linear("nitinol", 60.0) - blood) * 0.36e-3), 0.77, 5e-3);
  EXPECT_NEAR(std::exp(-table.linear("platinum", 60.0) * 0.36e-3), 0.035, 5e-4);
}

TEST(AttenuationTable, ReproducesItsPointsAndInterpolatesLogarithmically)
{
  const AttenuationTable table = AttenuationTable::load(kTable);
  EXPECT_NEAR(table.mass("blood", 30.0), 0.0380, 1e-12);
  EXPECT_NEAR(table.mass("blood", 100.0), 0.0169, 1e-12);
  EXPECT_NEAR(table.mass("steel", 60.0), 0.121, 1e-12);
  EXPECT_NEAR(table.mass("steel", std::sqrt(60.0 * 70.0)), std::sqrt(0.121 * 0.082), 1e-12);
}

TEST(AttenuationTable, IsDiscontinuousAtAbsorptionEdges)
{
  const AttenuationTable table = AttenuationTable::load(kTable);
  EXPECT_LT(table.mass("iodine", 33.1), 0.7);
  EXPECT_GT(table.mass("iodine", 33.2), 3.5);
  EXPECT_LT(table.mass("filled_polymer", 37.4), 0.14);
  EXPECT_GT(table.mass("filled_polymer", 37.5), 0.6);
  EXPECT_LT(table.mass("platinum", 78.3), 0.23);
  EXPECT_GT(table.mass("platinum", 78.4), 0.9);
}

TEST(AttenuationTable, ContainsEveryMaterialOfInstruments)
{
  const AttenuationTable table = AttenuationTable::load(kTable);
  for (const char* material :
       {"nitinol", "steel", "platinum", "polymer", "filled_polymer", "soft_tissue", "cortical_bone"})
    EXPECT_GT(table.linear(material, 60.0), 10.0) << material;
}

TEST(AttenuationTable, RejectsUnknownMaterialsAndEnergiesByName)
{
  const AttenuationTable table = AttenuationTable::load(kTable);
  EXPECT_THROW(table.linear("kryptonite", 60.0), InputError);
  EXPECT_THROW(table.linear("steel", 29.9), InputError);
  EXPECT_THROW(table.linear("steel", 100.1), InputError);
}

TEST(AttenuationTable, RejectsInvalidFilesByKey)
{
  const std::string file = testing::TempDir() + "attenuation.yaml";
  const auto message = [&](const std::string& text) -> std::string
  {
    std::ofstream(file) << text;
    try
    {
      AttenuationTable::load(file);
      return "";
    }
    catch (const InputError& error)
    {
      return error.what();
    }
  };
  EXPECT_EQ(message("a: {density: 1, energy: [30, 40], mass_attenuation: [2, 1]}"), "");
  EXPECT_NE(message("a: {density: -1, energy: [30, 40], mass_attenuation: [2, 1]}").find("a.density"),
            std::string::npos);
  EXPECT_NE(message("a: {density: 1, energy: [30], mass_attenuation: [2]}").find("a.energy"), std::string::npos);
  EXPECT_NE(message("a: {density: 1, energy: [40, 30], mass_attenuation: [2, 1]}").find("increase"), std::string::npos);
  EXPECT_NE(message("a: {density: 1, energy: [30, 40], mass_attenuation: [3, 2, 1]}").find("one value per energy"),
            std::string::npos);
  EXPECT_NE(message("a: {density: 1, energy: [30, x], mass_attenuation: [2, 1]}").find("a.energy[1]"),
            std::string::npos);
  EXPECT_NE(message("a: 5").find("must contain"), std::string::npos);
  EXPECT_NE(message("").find("must map"), std::string::npos);
  EXPECT_NE(message("a: [").find("YAML"), std::string::npos);
  EXPECT_THROW(AttenuationTable::load("/nowhere.yaml"), InputError);
}

}  // namespace
}  // namespace endovascular_sim::fluoroscopy
