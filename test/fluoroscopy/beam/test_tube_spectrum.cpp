#include "fluoroscopy/beam/tube_spectrum.h"

#include <gtest/gtest.h>

#include <cmath>

namespace endovascular_sim::fluoroscopy
{
namespace
{

constexpr double kAluminium = 2699.0;              // density [kg/m³]
constexpr double kPtbAnode = 20.0 * M_PI / 180.0;  // anode angle [rad]

EnergyTable table(const char* compound)
{
  return massAttenuationTable({{compound, 1.0}});
}

/** Beam of PTB's catalogue: 1 mm of beryllium, a monitor chamber of 0.25 mm of Kapton, 0.95 m of air, and aluminium. */
Spectrum ptbBeam(double voltage, double aluminium)
{
  static const EnergyTable kAl = table("Al"), kBe = table("Be"), kKapton = table("Kapton Polyimide Film"),
                           kAir = table("Air, Dry (near sea level)");
  Spectrum spectrum = tungstenSpectrum(voltage, kPtbAnode);
  spectrum = filtered(spectrum, kAl, kAluminium * aluminium);
  spectrum = filtered(spectrum, kBe, 1848.0 * 1e-3);
  spectrum = filtered(spectrum, kKapton, 1420.0 * 0.25e-3);
  return filtered(spectrum, kAir, 1.205 * 0.95);
}

double layer(const Spectrum& spectrum, double fraction = 0.5)
{
  return halfValueLayer(spectrum, {{"Al", 1.0}}, kAluminium, fraction);
}

// U. Ankerhold, Catalogue of X-ray spectra and their characteristic data, PTB-Dos-34 (2000), DOI 10.7795/110.20190315B;
// values as quoted by SpekPy's example beams_ptb_iec.py.
TEST(TubeSpectrum, ReproducesTheHalfValueLayersOfPtbsCatalogue)
{
  const struct
  {
    double voltage, aluminium, first, second;  // [kV], [mm]
  } kBeams[] = {{50, 2.5, 1.72, 2.30},    {60, 2.5, 2.02, 2.84},    {70, 2.5, 2.29, 3.37},  {80, 2.5, 2.59, 3.96},
                {90, 2.5, 2.91, 4.57},    {100, 2.5, 3.23, 5.19},   {120, 2.5, 3.88, 6.37}, {50, 12.5, 3.67, 4.05},
                {60, 18.5, 5.24, 5.70},   {70, 23.5, 6.64, 7.16},   {80, 28.5, 7.96, 8.50}, {90, 32.5, 9.03, 9.57},
                {100, 36.5, 9.93, 10.47}, {120, 42.5, 11.37, 11.97}};
  double squares = 0.0;
  for (const auto& beam : kBeams)
  {
    const Spectrum spectrum = ptbBeam(beam.voltage, 1e-3 * beam.aluminium);
    const double first = 1e3 * layer(spectrum), both = 1e3 * layer(spectrum, 0.25);
    EXPECT_NEAR(first, beam.first, 0.035 * beam.first) << beam.voltage << " kV " << beam.aluminium << " mm";
    EXPECT_NEAR(both - first, beam.second, 0.035 * beam.second) << beam.voltage << " kV " << beam.aluminium << " mm";
    squares += std::pow(first / beam.first - 1.0, 2) / std::size(kBeams);
  }
  EXPECT_LT(std::sqrt(squares), 0.02);
}

TEST(TubeSpectrum, ReproducesTheHalfValueLayersOfTheRqrBeams)
{
  // Filtrations: docs/XRAY_IMAGES.md, "Beam".
  const struct
  {
    double voltage, aluminium, half_value_layer;  // [kV], [mm]
  } kBeams[] = {{50, 2.55, 1.8}, {70, 2.89, 2.6}, {80, 3.24, 3.0}, {100, 3.36, 4.0}, {120, 3.73, 5.0}};
  for (const auto& beam : kBeams)
    EXPECT_NEAR(1e3 * layer(ptbBeam(beam.voltage, 1e-3 * beam.aluminium)), beam.half_value_layer,
                0.05 * beam.half_value_layer)
        << beam.voltage << " kV";
}

TEST(TubeSpectrum, HasTheOutputOfAClinicalTube)
{
  // SpekPy: 158.7 µGy/mAs at 1 m for 120 kV, 12°, 2.5 mm Al.
  const Spectrum spectrum = filtered(filtered(tungstenSpectrum(120.0), table("Al"), kAluminium * 2.5e-3),
                                     table("Air, Dry (near sea level)"), 1.205);
  EXPECT_NEAR(1e6 * airKerma(spectrum), 158.7, 0.01 * 158.7);
}

TEST(TubeSpectrum, EndsAtTheTubeVoltageAndShowsKLinesAboveTheEdge)
{
  const Spectrum soft = tungstenSpectrum(65.0), hard = tungstenSpectrum(100.0);
  for (std::size_t e = 66; e < kEnergies; ++e)
    EXPECT_EQ(soft[e], 0.0);
  EXPECT_LT(soft[59], soft[57]);
  EXPECT_GT(hard[59], 1.5 * hard[61]);
  EXPECT_GT(hard[58], 1.2 * hard[61]);
}

TEST(TubeSpectrum, GrowsContinuouslyWithTheVoltage)
{
  const auto kerma = [](double voltage) { return airKerma(ptbBeam(voltage, 2.5e-3)); };
  const double a = kerma(80.0), b = kerma(80.4), c = kerma(80.8);
  EXPECT_GT(b, a);
  EXPECT_GT(c, b);
  EXPECT_LT(c / a, 1.03);
}

}  // namespace
}  // namespace endovascular_sim::fluoroscopy
