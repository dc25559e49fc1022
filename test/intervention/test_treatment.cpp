#include "intervention/treatment.h"

#include <gtest/gtest.h>

#include "common/error.h"
#include "intervention/lesion_report.h"
#include "test/intervention/treated_tube.h"

namespace endovascular_sim::intervention
{
namespace
{

instrument::Instrument catheter(bool with_stent)
{
  instrument::Instrument instrument;
  instrument.name = "balloon";
  instrument.kind = instrument::Kind::kBalloonCatheter;
  instrument.balloon = balloon();
  if (with_stent)
    instrument.stent = stent();
  return instrument;
}

/** Inflates to a pressure, holds it and deflates.
 *  @return events of all steps */
TreatmentEvents inflateAndDeflate(Treatment& treatment, VesselDilatation& opening, double pressure,
                                  const ShaftLine& shaft)
{
  TreatmentEvents all;
  const auto run = [&](double duration, double commanded)
  {
    for (double t = 0.0; t < duration; t += 0.05)
    {
      opening.applyLoad(treatment.step(0.05, commanded, &shaft));
      const TreatmentEvents& events = treatment.events();
      all.above_rated |= events.above_rated;
      all.burst |= events.burst;
      all.stent_placed |= events.stent_placed;
      all.over_expanded |= events.over_expanded;
      all.stent_lost |= events.stent_lost;
    }
  };
  run(10.0, pressure);
  run(20.0, -kAtmosphere);
  return all;
}

TEST(Treatment, LeavesTheRecoilAsStenosisAfterBalloonAngioplasty)
{
  const vessel::Vessel vessel = tubeWithLesion(0.7);
  VesselDilatation opening(vessel, DilatationLaw{});
  const vessel::PlacedLesion& lesion = vessel.lesions.front();
  EXPECT_NEAR(reportLesion(opening.mesh(), vessel.centreline, lesion).stenosis, 0.7, 0.01);
  Treatment treatment(catheter(false));
  const TreatmentEvents events = inflateAndDeflate(treatment, opening, 8.0 * kAtmosphere, shaftAt(kLesion));
  const LesionReport report = reportLesion(opening.mesh(), vessel.centreline, lesion);
  EXPECT_NEAR(report.stenosis, 0.10, 0.01);
  EXPECT_NEAR(report.minimal_diameter, 0.9 * 3.0e-3, 0.02e-3);
  EXPECT_NEAR(report.reference_diameter, 3.0e-3, 0.02e-3);
  EXPECT_FALSE(report.stented);
  EXPECT_FALSE(events.burst || events.above_rated || events.stent_lost || opening.atRisk());
}

TEST(Treatment, LeavesOnlyTheRecoilOfTheStent)
{
  const vessel::Vessel vessel = tubeWithLesion(0.7);
  VesselDilatation opening(vessel, DilatationLaw{});
  Treatment treatment(catheter(true));
  EXPECT_NEAR(treatment.radiusAt(12.5e-3), 0.55e-3, 1e-12);
  const TreatmentEvents events = inflateAndDeflate(treatment, opening, 8.0 * kAtmosphere, shaftAt(kLesion));
  EXPECT_TRUE(events.stent_placed);
  ASSERT_EQ(treatment.stent()->state(), StentPlacement::State::kPlaced);
  const LesionReport report =
      reportLesion(opening.mesh(), vessel.centreline, vessel.lesions.front(), &treatment.stent()->sleeve());
  EXPECT_NEAR(report.minimal_diameter, 0.95 * 3.0e-3 + 0.18e-3, 0.03e-3);
  EXPECT_NEAR(report.coverage, 1.0, 1e-9);
  EXPECT_GT(report.apposition, 0.99);
  EXPECT_NEAR(report.placement_error, 0.0, 1e-6);
  EXPECT_NEAR(treatment.radiusAt(12.5e-3), 0.45e-3, 0.2e-3) << "folded balloon without stent";
}

TEST(Treatment, CoversHalfTheLesionIfMisplacedByHalf)
{
  const vessel::Vessel vessel = tubeWithLesion(0.5);
  VesselDilatation opening(vessel, DilatationLaw{});
  Treatment treatment(catheter(true));
  // The proximal end of the placed stent, which is 14 mm long, lies at the throat of the lesion.
  const double length = stent().lengthAt(0.95 * 3.0e-3);
  inflateAndDeflate(treatment, opening, 8.0 * kAtmosphere, shaftAt(kLesion + 0.5 * length));
  const LesionReport report =
      reportLesion(opening.mesh(), vessel.centreline, vessel.lesions.front(), &treatment.stent()->sleeve());
  EXPECT_NEAR(report.coverage, 0.5, 0.005);
  EXPECT_NEAR(report.placement_error, 0.5 * length, 0.05e-3);
}

TEST(Treatment, LeavesATooSmallStentUnapposed)
{
  const vessel::Vessel vessel = tubeWithLesion(0.2, 2.0e-3);
  VesselDilatation opening(vessel, DilatationLaw{});
  Treatment treatment(catheter(true));
  inflateAndDeflate(treatment, opening, 5.0 * kAtmosphere,
                    shaftAt(0.045));  // in the healthy vessel distal to the lesion
  const LesionReport report =
      reportLesion(opening.mesh(), vessel.centreline, vessel.lesions.front(), &treatment.stent()->sleeve());
  EXPECT_EQ(report.apposition, 0.0) << "2.7 mm in 4 mm";
  EXPECT_NEAR(report.coverage, 0.0, 1e-9);
}

TEST(Treatment, ReportsRuptureAndCriticalStretch)
{
  const vessel::Vessel vessel = tubeWithLesion(0.5, 1.1e-3);
  VesselDilatation opening(vessel, DilatationLaw{});
  Treatment treatment(catheter(false));
  const TreatmentEvents events = inflateAndDeflate(treatment, opening, 25.0 * kAtmosphere, shaftAt(kLesion));
  EXPECT_TRUE(events.above_rated);
  EXPECT_TRUE(events.burst);
  EXPECT_TRUE(opening.atRisk());
  EXPECT_EQ(treatment.inflation().diameter(), 0.9e-3);
}

TEST(Treatment, HasNoLoadUnderAnotherCatheterAndLosesItsStentOutsideTheVessel)
{
  Treatment covered(catheter(false));
  const ShaftLine shaft = shaftAt(kLesion);
  for (int k = 0; k < 40; ++k)
    covered.step(0.05, 8.0 * kAtmosphere, &shaft, 12.5e-3);
  const RoundBody& body = covered.load().balloon;
  for (std::size_t k = 0; k < body.axis.size(); ++k)
  {
    const double z = body.axis[k].z();
    EXPECT_TRUE(z <= kLesion + 1e-9 || z >= kLesion + 7.5e-3 || body.radii[k] > 1.4e-3) << z;
    EXPECT_TRUE(z >= kLesion - 1e-9 || body.radii[k] == 0.0) << z;
  }
  Treatment outside(catheter(true));
  bool lost = false;
  for (int k = 0; k < 40; ++k)
  {
    EXPECT_TRUE(outside.step(0.05, 8.0 * kAtmosphere, nullptr).balloon.axis.empty());
    lost = lost || outside.events().stent_lost;
  }
  EXPECT_TRUE(lost);
  EXPECT_EQ(outside.stent()->state(), StentPlacement::State::kLost);
}

TEST(Treatment, LosesAStentThatIsDislodgedBeforeExpansion)
{
  Treatment treatment(catheter(true));
  const ShaftLine shaft = shaftAt(kLesion);
  treatment.step(0.05, 0.0, &shaft);
  treatment.dislodgeStent();
  EXPECT_FALSE(treatment.carriesStent());
  EXPECT_FALSE(treatment.step(0.05, 0.0, &shaft).sleeve);
  EXPECT_TRUE(treatment.events().stent_lost);
  treatment.step(0.05, 0.0, &shaft);
  EXPECT_FALSE(treatment.events().stent_lost) << "reported once";
  EXPECT_NEAR(treatment.radiusAt(12.5e-3), 0.45e-3, 1e-12) << "folded balloon without stent";
}

TEST(Treatment, RequiresABalloon)
{
  instrument::Instrument wire;
  wire.name = "guidewire_014";
  EXPECT_THROW(Treatment{wire}, InputError);
}

}  // namespace
}  // namespace endovascular_sim::intervention
