#include "fluoroscopy/fluoroscope.h"

#include <gtest/gtest.h>

#include <cmath>

#include "common/error.h"
#include "contrast/lumen/divide_lumen.h"
#include "fluoroscopy/patient/progressive_projection.h"
#include "test/contrast/lumen_fixtures.h"
#include "test/fluoroscopy/motion_fixtures.h"
#include "test/fluoroscopy/shapes.h"

namespace endovascular_sim::fluoroscopy
{
namespace
{

const MaterialLibrary& library()
{
  static const MaterialLibrary kLibrary = MaterialLibrary::load(PROJECT_DIR "/config/xray/materials.yaml");
  return kLibrary;
}

/** Technique of high dose, so that noise is small. */
XRayScene scene()
{
  XRayScene scene;
  scene.exposure.detector_dose = 300e-9;
  scene.exposure.max_air_kerma_rate = 1.0;
  return scene;
}

/** Steel wire between two points, in the contrast medium. */
XRayWire steelWire(const Fluoroscope& fluoroscope, const Eigen::Vector3d& a, const Eigen::Vector3d& b, double radius)
{
  XRayWire wire;
  wire.nodes.push_back(a);
  appendEdge(wire, b, {{radius, fluoroscope.materials().solid("steel") - fluoroscope.vesselFluids().around}});
  return wire;
}

/** Mean count of 9 × 9 pixels. */
double meanCount(const Frame& frame, std::size_t pixel)
{
  double sum = 0.0;
  for (int row = -4; row <= 4; ++row)
    for (int column = -4; column <= 4; ++column)
      sum += frame.raw[pixel + static_cast<std::size_t>(row * frame.pixels + column)] / 81.0;
  return sum;
}

std::size_t nearestPixel(const XRayGeometry& geometry, const Eigen::Vector3d& point)
{
  const Eigen::Vector2d pixel = geometry.project(point);
  return static_cast<std::size_t>(std::lround(pixel.y()) * geometry.pixels() + std::lround(pixel.x()));
}

TEST(Fluoroscope, KeepsTheDoseAtTheDetectorBehindAnyTissue)
{
  for (const double thickness : {0.1, 0.2, 0.3})
  {
    XRayScene slab = scene();
    slab.tissue_thickness = thickness;
    Fluoroscope fluoroscope(CArmPose{}, slab, library());
    const Frame& frame = fluoroscope.render({});
    const double count = meanCount(frame, nearestPixel(fluoroscope.geometry(), {0.0, 0.0, 0.0}));
    const double wanted = DetectorImage::kCountsPerGray * 300e-9;
    EXPECT_GT(count, wanted) << thickness;  // scatter adds to the primary signal
    EXPECT_LT(count, 1.9 * wanted) << thickness;
    EXPECT_GT(frame.image[nearestPixel(fluoroscope.geometry(), {0.0, 0.0, 0.0})], 120);
  }
}

TEST(Fluoroscope, NeedsTheEntranceDoseOfAnAngiographySystem)
{
  XRayScene slab;
  slab.tissue_thickness = 0.2;  // attenuates somewhat less than 20 cm of PMMA, of which 24 to 30 mGy/min are known
  Fluoroscope fluoroscope(CArmPose{}, slab, library());
  const double rate = fluoroscope.render({}).reference_kerma * 15.0 * 60.0;  // [Gy/min]
  EXPECT_GT(rate, 20e-3);
  EXPECT_LT(rate, 35e-3);
}

TEST(Fluoroscope, ShowsContrastMediumByItsPolychromaticAttenuation)
{
  Fluoroscope fluoroscope(CArmPose{}, scene(), library());
  const std::size_t centre = nearestPixel(fluoroscope.geometry(), {0.0, 0.0, 0.0});
  const double before = meanCount(fluoroscope.render({}), centre) / fluoroscope.render({}).tube_charge;
  fluoroscope.setVessel(sphere({0.0, 0.0, 0.0}, 0.01, 60, 120));
  const double with = meanCount(fluoroscope.render({}), centre) / fluoroscope.render({}).tube_charge;
  const SignalTable table(Beam({}), library());
  const double primary = std::exp(table.integrate({212.0, 0.0, 150.0 * 0.0198}).log_signal -
                                  table.integrate({212.0, 0.0, 0.0}).log_signal);
  EXPECT_GT(with / before, primary);  // scatter fills the shadow
  EXPECT_LT(with / before, primary + 0.3);
}

TEST(Fluoroscope, GrowsNoisyBeyondTheLimitOfTheAirKermaRate)
{
  XRayScene thick;
  thick.tissue_thickness = 0.4;
  Fluoroscope fluoroscope(CArmPose{}, thick, library());
  const Frame& frame = fluoroscope.render({});
  EXPECT_TRUE(frame.dose_limited);
  EXPECT_NEAR(frame.reference_kerma * 15.0, 88e-3 / 60.0, 1e-8);
}

TEST(Fluoroscope, GivesEqualBitsForEqualSeedsAndNewNoiseInEveryFrame)
{
  Fluoroscope a(CArmPose{}, scene(), library()), b(CArmPose{}, scene(), library());
  const Frame first = a.render({});
  EXPECT_EQ(first.raw, b.render({}).raw);
  EXPECT_NE(first.raw, a.render({}).raw);
  a.restart();
  EXPECT_EQ(first.raw, a.render({}).raw);
  EXPECT_EQ(first.image, a.render({}, false).image);  // not drawn
}

/** Centroid (column, row) of all pixels darker than @p signal. */
Eigen::Vector2d centreOfShadow(const Frame& frame, int signal)
{
  Eigen::Vector2d sum = Eigen::Vector2d::Zero();
  double count = 0.0;
  for (int row = 0; row < frame.pixels; ++row)
    for (int column = 0; column < frame.pixels; ++column)
      if (frame.raw[static_cast<std::size_t>(row * frame.pixels + column)] < signal)
      {
        sum += Eigen::Vector2d(column, row);
        count += 1.0;
      }
  return sum / count;
}

TEST(Fluoroscope, RendersKnownPointsAtTheirProjectionAtAnyAngle)
{
  const Eigen::Vector3d bead(0.03, -0.02, 0.04);  // left, anterior and superior of the isocentre
  for (const double lao : {0.0, 0.8, -0.8, 1.5707963})
    for (const double cranial : {0.0, 0.4, -0.4})
    {
      CArmPose pose;
      pose.primary_angle = lao;
      pose.secondary_angle = cranial;
      Fluoroscope fluoroscope(pose, scene(), library());
      const XRayWire wire = steelWire(fluoroscope, 0.5 * bead - Eigen::Vector3d(0.0, 0.0, 1e-3),
                                      0.5 * bead + Eigen::Vector3d(0.0, 0.0, 1e-3), 1.5e-3);
      const Eigen::Isometry3d optical = fluoroscope.geometry().patientFromOptical().inverse();
      const Eigen::Matrix3d k = fluoroscope.geometry().cameraMatrix();
      EXPECT_LT(
          (centreOfShadow(fluoroscope.render({wire}), 14000) - (k * (optical * (0.5 * bead))).hnormalized()).norm(),
          0.5);
      fluoroscope.setVessel(sphere(bead, 0.004, 30, 60));
      EXPECT_LT((centreOfShadow(fluoroscope.render({}), 16000) - (k * (optical * bead)).hnormalized()).norm(), 0.5);
    }
}

TEST(Fluoroscope, DarkensThePixelsOfAWire)
{
  Fluoroscope fluoroscope(CArmPose{}, scene(), library());
  fluoroscope.setVessel(cylinder({0.0, 0.0, -0.05}, {0.0, 0.0, 0.05}, 0.004, 60));
  const Frame before = fluoroscope.render({});
  fluoroscope.restart();
  const Frame with = fluoroscope.render({steelWire(fluoroscope, {0.0, 0.0, -0.04}, {0.0, 0.0, 0.04}, 0.45e-3)});
  int darker = 0;
  for (std::size_t k = 0; k < with.raw.size(); ++k)
    darker += with.raw[k] < 0.93 * before.raw[k] ? 1 : 0;
  EXPECT_GT(darker, 100);
  EXPECT_LT(darker, 1000);
}

TEST(Fluoroscope, EqualsANewInstanceAfterMovesAndNewVessels)
{
  CArmPose lao;
  lao.primary_angle = 0.7;
  const geometry::TriangleMesh first = sphere({0.0, 0.0, 0.0}, 0.01, 20, 20);
  const geometry::TriangleMesh second = sphere({0.01, 0.0, 0.02}, 0.012, 20, 20);
  Fluoroscope used(CArmPose{}, scene(), library());
  const auto firstFrame = [](Fluoroscope& fluoroscope)
  {
    fluoroscope.restart();
    return fluoroscope.render({});
  };
  used.setVessel(first);
  used.render({});
  used.setPose(lao);
  Fluoroscope moved(lao, scene(), library());
  moved.setVessel(first);
  EXPECT_EQ(firstFrame(used).raw, firstFrame(moved).raw);
  used.setVessel(second);
  Fluoroscope changed(lao, scene(), library());
  changed.setVessel(second);
  EXPECT_EQ(firstFrame(used).image, firstFrame(changed).image);
  EXPECT_NE(firstFrame(used).raw, firstFrame(moved).raw);
}

/** Pose with a field of 0.1 m × 0.16 m on a detector of 0.3 m. */
CArmPose collimated()
{
  CArmPose pose;
  pose.field_width = 0.10;
  pose.field_height = 0.16;
  return pose;
}

/** Pixel at a distance from the detector's centre to the right and up [m]. */
std::size_t pixelAt(const CArmPose& pose, double right, double up)
{
  const double pitch = pose.detector_width / pose.pixels, centre = 0.5 * (pose.pixels - 1);
  return static_cast<std::size_t>(std::lround(centre - up / pitch) * pose.pixels + std::lround(centre + right / pitch));
}

TEST(Fluoroscope, OnlyATraceAndScatterReachTheDetectorBehindTheBladesOfTheCollimator)
{
  const CArmPose pose = collimated();
  Fluoroscope fluoroscope(pose, scene(), library());
  const Frame& frame = fluoroscope.render({});
  const double inside = meanCount(frame, pixelAt(pose, 0.0, 0.0));
  EXPECT_GT(inside, DetectorImage::kCountsPerGray * 300e-9);
  EXPECT_LT(meanCount(frame, pixelAt(pose, 0.14, 0.14)), 0.005 * inside);  // far from the field, a trace
  EXPECT_GT(meanCount(frame, pixelAt(pose, 0.14, 0.14)), 0.0005 * inside);
  EXPECT_LT(meanCount(frame, pixelAt(pose, 0.06, 0.0)), 0.3 * inside);  // scatter reaches beyond the edge
  EXPECT_GT(meanCount(frame, pixelAt(pose, 0.06, 0.0)), meanCount(frame, pixelAt(pose, 0.12, 0.0)));
  EXPECT_GT(meanCount(frame, pixelAt(pose, 0.0, 0.07)), 0.7 * inside);  // the field is higher than wide
}

TEST(Fluoroscope, ShowsTheBladesBlackAndTheFieldAsBrightAsBefore)
{
  const CArmPose pose = collimated();
  for (const bool inverted : {false, true})
  {
    XRayScene shown = scene();
    shown.display.inverted = inverted;
    Fluoroscope narrow(pose, shown, library()), open(CArmPose(), shown, library());
    const Frame& frame = narrow.render({});
    for (const auto& [right, up] : {std::pair(0.14, 0.14), {0.056, 0.0}, {-0.056, 0.02}, {0.0, 0.09}, {0.0, -0.12}})
      EXPECT_EQ(frame.image[pixelAt(pose, right, up)], 0) << right << " " << up << " " << inverted;
    const auto mean = [](const Frame& image, std::size_t pixel)
    {
      double sum = 0.0;
      for (int row = -4; row <= 4; ++row)
        for (int column = -4; column <= 4; ++column)
          sum += image.image[pixel + static_cast<std::size_t>(row * image.pixels + column)] / 81.0;
      return sum;
    };
    const Frame& whole = open.render({});
    for (const auto& [right, up] : {std::pair(0.0, 0.0), {0.04, 0.0}, {0.0, -0.07}})
      EXPECT_NEAR(mean(frame, pixelAt(pose, right, up)), mean(whole, pixelAt(pose, right, up)), 25.0)
          << right << " " << up << " " << inverted;
  }
}

TEST(Fluoroscope, MeasuresTheExposureInTheFieldOfTheCollimator)
{
  CArmPose narrow;
  narrow.field_width = narrow.field_height = 0.04;
  Fluoroscope collimated(narrow, scene(), library()), open(CArmPose(), scene(), library());
  const double charge = collimated.render({}).tube_charge;
  EXPECT_NEAR(charge, open.render({}).tube_charge, 0.02 * charge);
}

TEST(Fluoroscope, ASmallFieldScattersLess)
{
  CArmPose narrow;
  narrow.field_width = narrow.field_height = 0.06;
  Fluoroscope collimated(narrow, scene(), library()), open(CArmPose(), scene(), library());
  const double small = meanCount(collimated.render({}), pixelAt(narrow, 0.0, 0.0));
  const double large = meanCount(open.render({}), pixelAt(narrow, 0.0, 0.0));
  EXPECT_LT(small, 0.9 * large);
  EXPECT_GT(small, DetectorImage::kCountsPerGray * 300e-9 * 0.95);
}

TEST(Fluoroscope, AFieldAsWideAsTheDetectorChangesNoBit)
{
  CArmPose wide;
  wide.field_width = wide.field_height = wide.detector_width;
  Fluoroscope collimated(wide, scene(), library()), open(CArmPose(), scene(), library());
  const Frame& frame = collimated.render({});
  const Frame& expected = open.render({});
  EXPECT_EQ(frame.raw, expected.raw);
  EXPECT_EQ(frame.image, expected.image);
}

TEST(Fluoroscope, RetainsPoseAndVesselAfterARejection)
{
  Fluoroscope fluoroscope(CArmPose{}, scene(), library());
  fluoroscope.setVessel(sphere({0.0, 0.0, 0.0}, 0.01, 20, 20));
  const Frame before = fluoroscope.render({});
  CArmPose bad;
  bad.isocentre = {0.0, -0.75, 0.0};  // source inside the vessel
  EXPECT_THROW(fluoroscope.setPose(bad), InputError);
  EXPECT_THROW(fluoroscope.setVessel(sphere({0.0, 0.75, 0.0}, 0.01, 20, 20)), InputError);
  EXPECT_EQ(fluoroscope.geometry().pose(), CArmPose{});
  fluoroscope.restart();
  EXPECT_EQ(fluoroscope.render({}).raw, before.raw);
  XRayScene negative;
  negative.iodine = -1.0;
  EXPECT_THROW(Fluoroscope(CArmPose{}, negative, library()), InputError);
}

/** Patient whose image changes in every frame until it is final. */
class RefinedSlab : public Patient
{
public:
  explicit RefinedSlab(double density) : image_(emptyImage(512)), density_(density) {}

  const ArealDensityImage& frame(const XRayGeometry& /*geometry*/) override
  {
    if (revision_ < 3)
      image_.tissue.assign(image_.tissue.size(), static_cast<float>(100.0 + 20.0 * ++revision_));
    return image_;
  }
  int revision() const override { return revision_; }
  double lumenDensity() const override { return density_; }

private:
  ArealDensityImage image_;
  double density_;
  int revision_ = 0;
};

TEST(Fluoroscope, EveryRefinementOfThePatientAppearsInTheImage)
{
  Fluoroscope fluoroscope(CArmPose{}, scene(), library());
  fluoroscope.setPatient(std::make_unique<RefinedSlab>(1050.0));
  std::vector<double> charge;
  for (int k = 0; k < 60; ++k)
    charge.push_back(fluoroscope.render({}, false).tube_charge);
  Fluoroscope thick(CArmPose{}, scene(), library());
  thick.setPatient(std::make_unique<RefinedSlab>(1050.0));
  EXPECT_GT(charge.back(), 1.3 * charge.front());  // 160 instead of 120 kg/m²
  EXPECT_NEAR(charge.back() / charge[58], 1.0, 1e-3);
}

TEST(Fluoroscope, BloodReplacesThatOfThePatientAlongTheVessel)
{
  XRayScene plain = scene();
  plain.iodine = 0.0;
  std::vector<double> means;
  for (const bool vessel : {false, true})
  {
    Fluoroscope fluoroscope(CArmPose{}, plain, library());
    fluoroscope.setPatient(std::make_unique<RefinedSlab>(1062.0));
    if (vessel)
      fluoroscope.setVessel(sphere(Eigen::Vector3d::Zero(), 0.03, 32, 32));
    Frame frame;
    for (int k = 0; k < 4; ++k)
      frame = fluoroscope.render({}, false);
    means.push_back(meanCount(frame, nearestPixel(fluoroscope.geometry(), {0.0, 0.0, 0.0})));
  }
  EXPECT_NEAR(means[1] / means[0], 1.0, 0.02);  // 60 mm of blood, which differs by less than 10 kg/m³
}

TEST(Fluoroscope, DrawsAMovedVesselAsTheMeshThatIsMovedAtItsVertices)
{
  geometry::TriangleMesh mesh = sphere(motion::naturalHeart().fade.centre, 0.03, 20, 30);
  Fluoroscope moving(heartView(0.3, 0.1, 128), scene(), library()),
      wanted(heartView(0.3, 0.1, 128), scene(), library());
  moving.setVessel(mesh);
  moving.render({});
  moving.setMotion(largestMotion());
  moving.restart();
  for (Eigen::Vector3d& vertex : mesh.vertices)
    vertex = largestMotion().map().position(vertex);
  wanted.setVessel(mesh);
  const std::vector<std::uint16_t> raw = moving.render({}).raw;
  const std::vector<std::uint16_t>& exact = wanted.render({}).raw;
  for (std::size_t k = 0; k < raw.size(); ++k)
    ASSERT_NEAR(raw[k], exact[k], 1) << k;
}

TEST(Fluoroscope, AtRestHasTheBitsOfAPatientWithoutMotion)
{
  const geometry::TriangleMesh mesh = sphere(motion::naturalHeart().fade.centre, 0.03, 20, 30);
  const auto projection = std::make_shared<const VolumeProjection>(smoothBody(80, 3e-3));
  const CArmPose pose = heartView(0.3, 0.1, 96);
  Fluoroscope moving(pose, scene(), library()), resting(pose, scene(), library());
  for (Fluoroscope* each : {&moving, &resting})
  {
    each->setVessel(mesh);
    each->setPatient(std::make_unique<ProgressiveProjection>(projection, ProgressiveResolution{48, 48, 1}));
  }
  moving.setMotion(largestMotion());
  const std::vector<std::uint16_t> moved = moving.render({}).raw;
  moving.restart();
  for (int frame = 0; frame < 4; ++frame)
  {
    moving.setMotion(motionAt(0.0, 0.0));
    const std::vector<std::uint16_t> raw = moving.render({}).raw;
    EXPECT_NE(raw, moved);
    EXPECT_EQ(raw, resting.render({}).raw) << frame;
  }
}

/** Straight vessel of four cells across the view, and its lumen. */
struct ContrastVessel
{
  geometry::TriangleMesh mesh = cylinder({-0.05, 0.0, 0.0}, {0.05, 0.0, 0.0}, 4e-3, 48);
  std::shared_ptr<const contrast::LumenCells> lumen = std::make_shared<contrast::LumenCells>(
      contrast::divideLumen(mesh, {{{"trunk", -1, {{-0.05, 0.0, 0.0}, {0.05, 0.0, 0.0}}, {4e-3, 4e-3}}}},
                            {{0, 0.0, 0.03, -1}, {0, 0.03, 0.05, 0}, {0, 0.05, 0.07, 1}, {0, 0.07, 0.1, 2}}));

  Fluoroscope in(const XRayScene& technique) const
  {
    CArmPose pose;
    pose.pixels = 256;
    Fluoroscope fluoroscope(pose, technique, library());
    fluoroscope.setVessel(mesh);
    fluoroscope.setLumen(lumen);
    return fluoroscope;
  }
};

XRayScene withIodine(double iodine)
{
  XRayScene result = scene();
  result.iodine = iodine;
  return result;
}

TEST(Fluoroscope, DrawsAnEvenContrastAsTheIodineOfTheScene)
{
  const ContrastVessel vessel;
  Fluoroscope even = vessel.in(withIodine(120.0)), injected = vessel.in(withIodine(30.0));
  injected.setContrast(std::vector<double>(4, 120.0));
  const std::vector<std::uint16_t> wanted = even.render({}).raw;
  const std::vector<std::uint16_t> found = injected.render({}).raw;
  for (std::size_t k = 0; k < wanted.size(); ++k)
    ASSERT_NEAR(found[k], wanted[k], 2) << k;  // equal noise, within 1e-4 of the signal
}

TEST(Fluoroscope, WithoutIodineInAnyCellHasTheBitsOfAVesselWithoutIodine)
{
  const ContrastVessel vessel;
  Fluoroscope plain = vessel.in(withIodine(0.0)), none = vessel.in(withIodine(50.0));
  none.setContrast(std::vector<double>(4, 0.0));
  EXPECT_EQ(none.render({}).raw, plain.render({}).raw);
}

TEST(Fluoroscope, WithCellsButWithoutContrastHasTheBitsOfAVesselWithoutCells)
{
  const ContrastVessel vessel;
  Fluoroscope divided = vessel.in(withIodine(50.0)), plain = vessel.in(withIodine(50.0));
  plain.setLumen(nullptr);
  EXPECT_EQ(divided.render({}).raw, plain.render({}).raw);
}

TEST(Fluoroscope, DarkensTheCellsThatHoldContrast)
{
  const ContrastVessel vessel;
  Fluoroscope fluoroscope = vessel.in(scene());
  fluoroscope.setContrast({0.0, 0.0, 150.0, 0.0});
  const Frame frame = fluoroscope.render({});
  const auto count = [&](double x) { return meanCount(frame, nearestPixel(fluoroscope.geometry(), {x, 0.0, 0.0})); };
  EXPECT_LT(count(0.01), 0.75 * count(-0.01));
  EXPECT_NEAR(count(0.035), count(-0.035), 0.02 * count(-0.035));
  EXPECT_GT(count(0.035), 1.3 * count(0.01));
}

TEST(Fluoroscope, DrawsContrastWhateverItDrewBefore)
{
  const ContrastVessel vessel;
  const std::vector<double> contrast{10.0, 200.0, 0.0, 90.0};
  Fluoroscope fresh = vessel.in(scene()), used = vessel.in(scene());
  fresh.setContrast(contrast);
  const std::vector<std::uint16_t> wanted = fresh.render({}).raw;
  used.setContrast({300.0, 0.0, 20.0, 7.0});
  used.render({});
  used.setContrast({0.0, 0.0, 250.0, 0.0});
  used.render({});
  used.restart();
  used.setContrast(contrast);
  EXPECT_EQ(used.render({}).raw, wanted);
  used.setContrast({});
  fresh.setContrast({});
  used.restart(), fresh.restart();
  EXPECT_EQ(used.render({}).raw, fresh.render({}).raw);
}

TEST(Fluoroscope, LetsContrastFollowTheWallAndTheCArm)
{
  const ContrastVessel vessel;
  const std::vector<double> contrast{10.0, 200.0, 0.0, 90.0};
  geometry::TriangleMesh wide = vessel.mesh;
  for (Eigen::Vector3d& p : wide.vertices)
    p.tail<2>() *= 1.3;
  Fluoroscope fluoroscope = vessel.in(scene());
  fluoroscope.setContrast(contrast);
  fluoroscope.render({});
  fluoroscope.setVessel(wide);
  CArmPose pose = fluoroscope.geometry().pose();
  pose.primary_angle = 0.3;
  fluoroscope.setPose(pose);
  fluoroscope.restart();
  Fluoroscope wanted(pose, scene(), library());
  wanted.setVessel(vessel.mesh);
  wanted.setLumen(vessel.lumen);
  wanted.setVessel(wide);
  wanted.setContrast(contrast);
  EXPECT_EQ(fluoroscope.render({}).raw, wanted.render({}).raw);
}

TEST(Fluoroscope, RefusesContrastWithoutItsCells)
{
  const ContrastVessel vessel;
  Fluoroscope fluoroscope = vessel.in(scene());
  EXPECT_THROW(fluoroscope.setContrast({1.0, 2.0}), InputError);
  EXPECT_THROW(fluoroscope.setContrast({1.0, 2.0, -1.0, 0.0}), InputError);
  EXPECT_NO_THROW(fluoroscope.setContrast({1.0, 2.0, 1.0, 0.0}));
  fluoroscope.setVessel(sphere({0.0, 0.0, 0.0}, 0.02, 12, 12));
  EXPECT_THROW(fluoroscope.setContrast({1.0, 2.0, 1.0, 0.0}), InputError) << "another vessel has lost the cells";
  EXPECT_THROW(fluoroscope.setLumen(vessel.lumen), InputError);
}

/** Largest difference of grey levels that the natural anatomy makes without contrast, outside of the noise. */
TEST(Fluoroscope, WithoutContrastShowsCoronaryArteriesByLessThanAGreyLevel)
{
  XRayScene technique = withIodine(0.0);
  technique.exposure.detector_dose = 100e-9;
  Fluoroscope with(heartView(-0.52, -0.35, 512), technique, library());
  Fluoroscope without(heartView(-0.52, -0.35, 512), technique, library());
  const contrast::DividedVessel& vessel = contrast::generatedVessel("natural");
  with.setVessel(vessel.mesh);
  const std::vector<std::uint8_t> seen = with.render({}).image, empty = without.render({}).image;
  double squares = 0.0;
  std::size_t count = 0;
  for (const vessel::CentrelineBranch& branch : vessel.centreline.branches)
    if (branch.name == "left_anterior_descending" || branch.name == "left_circumflex" ||
        branch.name == "right_coronary")
      for (std::size_t k = branch.points.size() / 4; k < branch.points.size(); ++k, ++count)
      {
        const std::size_t pixel = nearestPixel(with.geometry(), branch.points[k]);
        squares += std::pow(static_cast<double>(seen[pixel]) - static_cast<double>(empty[pixel]), 2);
      }
  EXPECT_GT(count, 100U);
  EXPECT_LT(std::sqrt(squares / static_cast<double>(count)), 1.0);
}

}  // namespace
}  // namespace endovascular_sim::fluoroscopy
