#include "fluoroscopy/beam/material_library.h"

#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <string>

#include "common/error.h"
#include "test/common/input_error_of.h"

namespace endovascular_sim::fluoroscopy
{
namespace
{

const std::string kTable = PROJECT_DIR "/config/xray/materials.yaml";

TEST(MaterialLibrary, ReproducesKnownTransmissionsAt60keV)
{
  const MaterialLibrary table = MaterialLibrary::load(kTable);
  const double blood = table.linear("blood", 60.0);
  const auto vessel = [&](double iodine) { return std::exp(-(table.contrast(iodine, 60.0) - blood) * 4e-3); };
  EXPECT_NEAR(vessel(300.0), 0.403, 5e-4);
  EXPECT_NEAR(vessel(150.0), 0.635, 5e-4);
  EXPECT_NEAR(vessel(50.0), 0.859, 5e-4);
  EXPECT_NEAR(std::exp(-table.contrast(300.0, 60.0) * 4e-3), 0.37, 5e-3);
  EXPECT_NEAR(std::exp(-(table.linear("nitinol", 60.0) - blood) * 0.36e-3), 0.77, 5e-3);
  EXPECT_NEAR(std::exp(-table.linear("platinum", 60.0) * 0.36e-3), 0.035, 5e-4);
}

TEST(MaterialLibrary, ReproducesTheTabulatedCoefficientsOfXraylib)
{
  const MaterialLibrary table = MaterialLibrary::load(kTable);
  EXPECT_NEAR(table.mass("blood", 30.0), 0.0380, 5e-5);
  EXPECT_NEAR(table.mass("blood", 100.0), 0.0169, 5e-5);
  EXPECT_NEAR(table.mass("steel", 60.0), 0.1205, 5e-5);
  EXPECT_NEAR(table.mass("iodine", 60.0), 0.7577, 5e-5);
}

TEST(MaterialLibrary, AddsUpTheCompoundsOfAMixtureByMass)
{
  const MaterialLibrary table = MaterialLibrary::load(kTable);
  EXPECT_NEAR(table.mass("filled_polymer", 60.0),
              0.446 * massAttenuation({{"C12H23NO", 1.0}}, 60.0) + 0.297 * massAttenuation({{"BaSO4", 1.0}}, 60.0) +
                  0.257 * massAttenuation({{"Fe", 1.0}}, 60.0),
              1e-12);
  EXPECT_LT(massEnergyAbsorption({{"Water, Liquid", 1.0}}, 60.0),
            0.2 * massAttenuation({{"Water, Liquid", 1.0}}, 60.0));
}

TEST(MaterialLibrary, IsDiscontinuousAtAbsorptionEdges)
{
  const MaterialLibrary table = MaterialLibrary::load(kTable);
  EXPECT_LT(table.mass("iodine", 33.1), 0.7);
  EXPECT_GT(table.mass("iodine", 33.2), 3.5);
  EXPECT_LT(table.mass("filled_polymer", 37.4), 0.23);
  EXPECT_GT(table.mass("filled_polymer", 37.5), 0.6);
  EXPECT_LT(table.mass("platinum", 78.3), 0.23);
  EXPECT_GT(table.mass("platinum", 78.4), 0.9);
}

TEST(MaterialLibrary, ContainsEveryMaterialOfInstruments)
{
  const MaterialLibrary table = MaterialLibrary::load(kTable);
  for (const char* material :
       {"nitinol", "steel", "platinum", "polymer", "filled_polymer", "soft_tissue", "cortical_bone"})
    EXPECT_GT(table.linear(material, 60.0), 10.0) << material;
}

TEST(MaterialLibrary, RejectsUnknownMaterialsByName)
{
  const MaterialLibrary table = MaterialLibrary::load(kTable);
  EXPECT_THROW(table.linear("kryptonite", 60.0), InputError);
}

/** Message of the error of a library with this text; empty for a valid one. */
std::string messageOf(const std::string& text)
{
  const std::string file = testing::TempDir() + "materials.yaml";
  std::ofstream(file) << text;
  return inputErrorOf([&] { MaterialLibrary::load(file); });
}

TEST(MaterialLibrary, RejectsInvalidFilesByKey)
{
  const auto names = [&](const std::string& text, const std::string& key)
  { return messageOf(text).find(key) != std::string::npos; };
  EXPECT_EQ(messageOf("a: {density: 1, composition: H2O}"), "");
  EXPECT_EQ(messageOf("a: {density: 1, composition: {H2O: 0.4, 'Water, Liquid': 0.6}}"), "");
  EXPECT_TRUE(names("a: {density: -1, composition: H2O}", "a.density"));
  EXPECT_TRUE(names("a: {density: 1, composition: Kryptonite}", "a.composition"));
  EXPECT_TRUE(names("a: {density: 1, composition: {H2O: 0.4, C: 0.5}}", "add up to 1"));
  EXPECT_TRUE(names("a: {density: 1, composition: {H2O: x}}", "a.composition.H2O"));
  EXPECT_TRUE(names("a: {density: 1}", "a.composition"));
  EXPECT_TRUE(names("a: {density: 1, energy: [30, 40], mass_attenuation: [2, 1]}", "a.composition (line 1): missing"));
  EXPECT_TRUE(names("a: 5", "a (line 1): expected a map"));
  EXPECT_TRUE(names("", "has no keys"));
  EXPECT_TRUE(names("a: [", "YAML"));
  EXPECT_THROW(MaterialLibrary::load("/nowhere.yaml"), InputError);
}

TEST(MaterialLibrary, RejectsAnUnknownKeyWithFileLineAndTheNearestKey)
{
  EXPECT_EQ(messageOf("a:\n  density: 1\n  composition: H2O\n  densty: 2\n"),
            testing::TempDir() + "materials.yaml: a.densty (line 4): unknown key; did you mean \"density\"?");
  EXPECT_EQ(messageOf("a: {density: 1, composition: H2O, colour: red}\n"),
            testing::TempDir() + "materials.yaml: a.colour (line 1): unknown key; known keys: density, composition");
}

}  // namespace
}  // namespace endovascular_sim::fluoroscopy
