#include "fluoroscopy/beam/beam.h"

#include <gtest/gtest.h>

#include <cmath>

#include "common/error.h"

namespace endovascular_sim::fluoroscopy
{
namespace
{

double sum(const Spectrum& spectrum)
{
  double result = 0.0;
  for (const double value : spectrum)
    result += value;
  return result;
}

/** Transmission of a 4 mm vessel relative to blood without iodine, behind 20 cm of water. */
double vesselTransmission(const BeamSettings& settings, double iodine)
{
  const EnergyTable water = massAttenuationTable({{"Water, Liquid", 1.0}});
  const Spectrum behind = filtered(Beam(settings).signal(), water, 200.0);
  return sum(filtered(behind, massAttenuationTable({{"I", 1.0}}), 4e-3 * iodine)) / sum(behind);
}

TEST(Beam, ShowsIodineAsKnownAt60keV)
{
  BeamSettings settings;
  settings.energy = 60.0;
  EXPECT_NEAR(vesselTransmission(settings, 300.0), 0.403, 5e-4);
  EXPECT_NEAR(vesselTransmission(settings, 150.0), 0.635, 5e-4);
  EXPECT_NEAR(vesselTransmission(settings, 50.0), 0.859, 5e-4);
}

TEST(Beam, ShowsIodineAsKnownAt80kV)
{
  const BeamSettings settings;  // 80 kV, 2.5 mm Al, 0.2 mm Cu
  EXPECT_NEAR(vesselTransmission(settings, 300.0), 0.368, 0.02);
  EXPECT_NEAR(vesselTransmission(settings, 150.0), 0.591, 0.02);
  EXPECT_NEAR(vesselTransmission(settings, 50.0), 0.833, 0.02);
}

TEST(Beam, HasTheKnownPhotonFluencePerDetectorDose)
{
  // 25 to 40 photons/mm² per nGy in the diagnostic range (IEC 62220-1: 30.2 for RQA 5).
  const Spectrum behind = filtered(Beam({}).detector(), massAttenuationTable({{"Water, Liquid", 1.0}}), 200.0);
  EXPECT_NEAR(sum(behind) / airKerma(behind) * 1e-15, 33.7, 1.0);
}

TEST(Beam, NeedsTheEntranceDoseOfAnAngiographySystem)
{
  // 20 cm of PMMA, 15 frames/s of 30 nGy; source to detector 1.2 m, reference point at 0.6 m.
  const Beam beam({});
  const double detector =
      airKerma(filtered(beam.detector(), massAttenuationTable({{"C5H8O2", 1.0}}), 1190.0 * 0.2)) / (1.2 * 1.2);
  const double entrance = airKerma(beam.entrance()) / (0.6 * 0.6);
  const double rate = entrance / detector * 30e-9 * 15.0 * 60.0;  // [Gy/min]
  EXPECT_GT(rate, 24e-3);
  EXPECT_LT(rate, 30e-3);
}

TEST(Beam, RejectsTechniqueFactorsOutOfRange)
{
  BeamSettings settings;
  settings.tube_voltage = 49.0;
  EXPECT_THROW(Beam{settings}, InputError);
  settings.tube_voltage = 126.0;
  EXPECT_THROW(Beam{settings}, InputError);
  settings.tube_voltage = std::nan("");
  EXPECT_THROW(Beam{settings}, InputError);
  settings = {};
  settings.copper = -1e-4;
  EXPECT_THROW(Beam{settings}, InputError);
  settings = {};
  settings.energy = 5.0;
  EXPECT_THROW(Beam{settings}, InputError);
}

}  // namespace
}  // namespace endovascular_sim::fluoroscopy
