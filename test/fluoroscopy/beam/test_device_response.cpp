#include "fluoroscopy/beam/device_response.h"

#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <string>
#include <vector>

#include "fluoroscopy/beam/signal_table.h"

namespace endovascular_sim::fluoroscopy
{
namespace
{

const MaterialLibrary& library()
{
  static const MaterialLibrary kLibrary = MaterialLibrary::load(PROJECT_DIR "/config/xray/materials.yaml");
  return kLibrary;
}

const EnergyTable& mass(const std::string& material)
{
  static std::map<std::string, EnergyTable> tables;
  const auto found = tables.find(material);
  return found != tables.end() ? found->second
                               : tables[material] = massAttenuationTable(library().composition(material));
}

double sum(const Spectrum& spectrum)
{
  double result = 0.0;
  for (const double value : spectrum)
    result += value;
  return result;
}

struct Layer
{
  const char* material;
  double thickness;  // [m]
};

/** Largest error of the transmission of a stack of layers behind 50 to 400 kg/m² of tissue and 0 to 60 kg/m² of bone.
 */
double worstError(const BeamSettings& settings, const std::vector<Layer>& layers)
{
  const Beam beam(settings);
  const SignalTable table(beam, library());
  const DeviceResponse response(beam, library());
  const EnergyTable tissue = mass("soft_tissue");
  const EnergyTable bone = mass("cortical_bone");
  double worst = 0.0;
  for (const double t : {50.0, 100.0, 200.0, 300.0, 400.0})
    for (const double b : {0.0, 20.0, 60.0})
    {
      const Spectrum patient = filtered(filtered(beam.signal(), tissue, t), bone, b);
      Spectrum device = patient;
      DeviceDensity areal;
      for (const Layer& layer : layers)
      {
        device = filtered(device, mass(layer.material), library().density(layer.material) * layer.thickness);
        areal = areal + layer.thickness * response.solid(layer.material);
      }
      const DeviceCoefficients coefficients = response.coefficients(table.at({t, b, 0.0}).steel_slope);
      const double seen =
          std::exp(-opticalDepth(coefficients, static_cast<float>(areal.steel), static_cast<float>(areal.water)));
      worst = std::max(worst, std::abs(seen - sum(device) / sum(patient)));
    }
  return worst;
}

TEST(DeviceResponse, EqualsDirectIntegrationForSingleMaterials)
{
  for (const double voltage : {65.0, 80.0, 100.0, 125.0})
    for (const double fraction : {0.1, 0.4, 1.0})
    {
      const BeamSettings settings{voltage, 2.5e-3, 0.2e-3, {}};
      for (const Layer& layer : {Layer{"nitinol", 0.5e-3}, Layer{"steel", 0.9e-3}, Layer{"polymer", 1.5e-3}})
        EXPECT_LT(worstError(settings, {{layer.material, fraction * layer.thickness}}), 0.01)
            << layer.material << " " << voltage << " kV";
      EXPECT_LT(worstError(settings, {{"filled_polymer", 1.5e-3 * fraction}}), 0.02) << voltage << " kV";
      // The K edge of platinum at 78.4 keV is outside of the span of steel and water.
      EXPECT_LT(worstError(settings, {{"platinum", 0.5e-3 * fraction}}), voltage > 82.0 ? 0.065 : 0.01)
          << voltage << " kV";
    }
}

TEST(DeviceResponse, EqualsDirectIntegrationForACoaxialStack)
{
  for (const double voltage : {70.0, 80.0})
  {
    EXPECT_LT(worstError({voltage, 2.5e-3, 0.2e-3, {}}, {{"filled_polymer", 0.4e-3}, {"steel", 0.36e-3}}), 0.01);
    EXPECT_LT(
        worstError({voltage, 2.5e-3, 0.2e-3, {}}, {{"nitinol", 0.3e-3}, {"platinum", 0.1e-3}, {"polymer", 0.5e-3}}),
        0.01);
  }
}

TEST(DeviceResponse, RemovesDisplacedContrastMedium)
{
  const Beam beam({});
  const SignalTable table(beam, library());
  const DeviceResponse response(beam, library());
  const double iodine = 150.0, vessel = 4e-3, displaced = 1.8e-3;  // [kg/m³], [m]
  const double tissue = 200.0;
  const float before = table.integrate({tissue, 0.0, iodine * vessel}).log_signal;
  const float after = table.integrate({tissue - displaced * 1060.0, 0.0, iodine * (vessel - displaced)}).log_signal;
  const DeviceDensity less = -displaced * response.blood(iodine);
  const float depth = opticalDepth(response.coefficients(table.at({tissue, 0.0, iodine * vessel}).steel_slope),
                                   static_cast<float>(less.steel), static_cast<float>(less.water));
  EXPECT_NEAR(std::exp(-depth), std::exp(after - before), 0.015 * std::exp(after - before));
}

TEST(DeviceResponse, IsExactForAMonoenergeticBeam)
{
  BeamSettings settings;
  settings.energy = 60.0;
  EXPECT_LT(worstError(settings, {{"filled_polymer", 0.4e-3}, {"steel", 0.36e-3}, {"platinum", 0.1e-3}}), 1e-4);
}

}  // namespace
}  // namespace endovascular_sim::fluoroscopy
