#include "fluoroscopy/angiography/angiography.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>

#include "common/error.h"
#include "fluoroscopy/angiography/subtraction.h"
#include "test/common/input_error_of.h"
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

XRayScene technique()
{
  XRayScene scene;
  scene.exposure.detector_dose = 150e-9;
  scene.exposure.max_air_kerma_rate = 1.0;
  scene.seed = 3;
  return scene;
}

CArmPose pose()
{
  CArmPose pose;
  pose.pixels = 128;
  pose.detector_width = 0.2;
  return pose;
}

/** Bodies whose edges are subtracted: spheres of blood. */
geometry::TriangleMesh bodies()
{
  return sphere({0.02, 0.0, 0.02}, 0.015, 20, 40);
}

/** Vessel with contrast medium beside them. */
geometry::TriangleMesh filled()
{
  return cylinder({-0.03, 0.0, -0.06}, {-0.03, 0.0, 0.06}, 0.004, 40);
}

double rootMeanSquare(const std::vector<double>& values)
{
  double sum = 0.0;
  for (const double value : values)
    sum += value * value;
  return std::sqrt(sum / static_cast<double>(values.size()));
}

/** X-ray system in which contrast medium is switched by the presence of the vessel. */
struct Room
{
  explicit Room(const CArmPose& at = pose()) : fluoroscope(at, technique(), library()), angiography(fluoroscope) {}

  const AngiographyFrame& draw() { return angiography.draw(pulse++, {}); }

  Fluoroscope fluoroscope;
  Angiography angiography;
  std::uint64_t pulse = 0;
};

/** Differences s of a frame and a mask of @p frames frames, and the noise of both images together. */
struct Rest
{
  double rms = 0.0, noise = 0.0;
};

/** Rest of a DSA beside the vessel, which appears after the mask. */
Rest restOf(int frames)
{
  Room room;
  Mask mask(frames);
  for (int k = 0; k < frames; ++k)
  {
    const AngiographyFrame& frame = room.draw();
    mask.add(frame.pulse, frame.native.raw, frame.native.tube_charge, pose());
  }
  room.fluoroscope.setVessel(filled());
  Pulse pulse;
  pulse.number = room.pulse;
  pulse.tube_charge = mask.tubeCharge();
  const std::vector<float> difference =
      logDifference(room.fluoroscope.render({}, pulse).raw, mask.logarithms(), 128, {0.0, 0.0});
  room.fluoroscope.setVessel({});
  const std::vector<std::uint16_t> a = room.fluoroscope.render({}, pulse).raw;
  pulse.number = 1000;
  const std::vector<std::uint16_t> b = room.fluoroscope.render({}, pulse).raw;
  std::vector<double> rest, noise;
  for (std::size_t k = 0; k < a.size(); ++k)
    if (k % 128 > 64)  // away from the vessel
    {
      rest.push_back(static_cast<double>(difference[k]));
      noise.push_back(std::log(static_cast<double>(a[k]) / static_cast<double>(b[k])));
    }
  // Two frames differ by √2 of the noise σ of one, frame and mask by √(1 + 1/n).
  return {rootMeanSquare(rest), rootMeanSquare(noise) / std::sqrt(2.0) * std::sqrt(1.0 + 1.0 / frames)};
}

TEST(Angiography, OfAStaticSceneShowsIodineOnly)
{
  for (const int frames : {1, 4})
  {
    const Rest rest = restOf(frames);
    std::printf("mask of %d frames: RMS of the rest %.4f, noise of the two images %.4f\n", frames, rest.rms,
                rest.noise);
    EXPECT_LE(rest.rms, 1.5 * rest.noise);
    EXPECT_GT(rest.rms, 0.8 * rest.noise);
  }
}

TEST(Angiography, ShowsTheVesselDarkOnAnEvenGround)
{
  Room room;
  room.angiography.begin(XRayMode::kSubtraction, 2);
  for (int k = 0; k < 2; ++k)
  {
    EXPECT_TRUE(room.angiography.takesMask());
    EXPECT_TRUE(room.draw().subtracted.empty());
    EXPECT_EQ(room.angiography.last()->mask, MaskState::kTaking);
  }
  EXPECT_FALSE(room.angiography.takesMask());
  room.fluoroscope.setVessel(filled());
  const AngiographyFrame& frame = room.draw();
  EXPECT_EQ(frame.mask, MaskState::kValid);
  ASSERT_EQ(frame.subtracted.size(), 128U * 128U);
  const Eigen::Vector2d vessel = room.fluoroscope.geometry().project({-0.03, 0.0, 0.0});
  const auto mean = [&](long column)
  {
    double sum = 0.0;
    for (int row = 54; row < 74; ++row)
      sum += frame.subtracted[static_cast<std::size_t>(row * 128 + column)] / 20.0;
    return sum;
  };
  EXPECT_NEAR(mean(100), 191.0, 12.0);
  EXPECT_LT(mean(std::lround(vessel.x())), mean(100) - 80.0);
}

TEST(Angiography, KeepsTheExposureOfItsFirstFrame)
{
  Room room;
  room.angiography.begin(XRayMode::kSubtraction, 1);
  const double charge = room.draw().native.tube_charge;
  room.fluoroscope.setVessel(sphere({0.0, 0.0, 0.0}, 0.04, 20, 40));
  EXPECT_EQ(room.draw().native.tube_charge, charge);
  room.angiography.begin(XRayMode::kLive);
  EXPECT_GT(room.draw().native.tube_charge, 1.1 * charge);
}

TEST(Angiography, AMaskIsInvalidAfterEachKindOfMotion)
{
  const std::pair<const char*, void (*)(CArmPose&)> motions[] = {
      {"the table has moved", [](CArmPose& to) { to.isocentre.z() += 1e-3; }},
      {"the C-arm has moved", [](CArmPose& to) { to.primary_angle += 0.01; }},
      {"the C-arm has moved", [](CArmPose& to) { to.secondary_angle += 0.01; }},
      {"the C-arm has moved", [](CArmPose& to) { to.source_to_detector += 0.01; }},
      {"the C-arm has moved", [](CArmPose& to) { to.source_to_patient += 0.01; }},
      {"the width of the detector has changed", [](CArmPose& to) { to.detector_width += 0.01; }},
      {"the collimated field has changed", [](CArmPose& to) { to.field_width = 0.1; }},
      {"the collimated field has changed", [](CArmPose& to) { to.field_height = 0.1; }}};
  for (const auto& [reason, move] : motions)
  {
    Room room;
    room.angiography.begin(XRayMode::kSubtraction, 1);
    room.draw();
    EXPECT_EQ(room.draw().mask, MaskState::kValid);
    CArmPose to = pose();
    move(to);
    room.fluoroscope.setPose(to);
    const AngiographyFrame& frame = room.draw();
    EXPECT_EQ(frame.mask, MaskState::kInvalid);
    EXPECT_TRUE(frame.subtracted.empty());
    EXPECT_EQ(frame.remark, std::string(reason) + " since the mask was taken; take a new one");
    room.angiography.begin(XRayMode::kSubtraction, 1);
    room.draw();
    EXPECT_EQ(room.draw().mask, MaskState::kValid);
  }
}

TEST(Angiography, APixelShiftUndoesAMotionOfThePatient)
{
  const double pitch = 0.2 / 128;
  const Eigen::Vector3d motion(1.5 * pitch * 0.75 / 1.2, 0.0, 0.7 * pitch * 0.75 / 1.2);  // 1.5 and −0.7 pixels
  std::vector<double> rests;
  for (const Eigen::Vector2d& shift : {Eigen::Vector2d(0.0, 0.0), Eigen::Vector2d(1.5, -0.7)})
  {
    Room room;
    room.fluoroscope.setVessel(bodies());
    room.angiography.begin(XRayMode::kSubtraction, 4);
    for (int k = 0; k < 4; ++k)
      room.draw();
    geometry::TriangleMesh moved = bodies();
    for (Eigen::Vector3d& vertex : moved.vertices)
      vertex += motion;
    room.fluoroscope.setVessel(moved);
    room.angiography.setShift(shift);
    const AngiographyFrame& frame = room.draw();
    std::vector<double> rest;
    for (int row = 20; row < 108; ++row)
      for (int column = 20; column < 108; ++column)
        rest.push_back(frame.subtracted[static_cast<std::size_t>(row * 128 + column)] - 191.0);
    rests.push_back(rootMeanSquare(rest));
  }
  std::printf("RMS of the rest without and with the shift: %.1f and %.1f grey levels\n", rests[0], rests[1]);
  EXPECT_LT(rests[1], 0.6 * rests[0]);
}

TEST(Angiography, ARoadmapFadesIntoTheLiveImageByItsShare)
{
  Room room;
  room.angiography.begin(XRayMode::kSubtraction, 1);
  room.draw();
  room.fluoroscope.setVessel(filled());
  room.draw();
  room.fluoroscope.setVessel({});
  room.draw();  // washed out
  const Eigen::Vector2d vessel = room.fluoroscope.geometry().project({-0.03, 0.0, 0.0});
  std::vector<double> contrast;
  room.angiography.begin(XRayMode::kRoadmap);
  for (const double share : {0.0, 0.25, 0.5})
  {
    room.angiography.setShare(share);
    const AngiographyFrame& frame = room.draw();
    EXPECT_EQ(frame.mask, MaskState::kValid);
    const auto mean = [&](long column)
    {
      double sum = 0.0;
      for (int row = 54; row < 74; ++row)
        sum += frame.native.image[static_cast<std::size_t>(row * 128 + column)] / 20.0;
      return sum;
    };
    contrast.push_back(mean(std::lround(vessel.x())) - mean(100));
  }
  EXPECT_NEAR(contrast[0], 0.0, 12.0);
  EXPECT_GT(contrast[1], contrast[0] + 10.0);
  EXPECT_NEAR(contrast[2] - contrast[0], 2.0 * (contrast[1] - contrast[0]), 12.0);
  CArmPose to = pose();
  to.primary_angle = 0.2;
  room.fluoroscope.setPose(to);
  EXPECT_EQ(room.draw().mask, MaskState::kInvalid);
  EXPECT_NE(room.angiography.last()->remark.find("begin a new DSA run"), std::string::npos);
  room.angiography.begin(XRayMode::kLive);
  Room fresh(to);
  fresh.pulse = room.pulse;
  EXPECT_EQ(room.draw().native.image, fresh.draw().native.image);  // nothing of it stays
}

TEST(Angiography, AFrameHasEqualBitsWhenThoseBeforeWereLeftOut)
{
  for (const bool subtracts : {false, true})
  {
    Room whole, sparse;
    for (Room* room : {&whole, &sparse})
      if (subtracts)
        room->angiography.begin(XRayMode::kSubtraction, 3);
    for (std::uint64_t pulse = 0; pulse < 12; ++pulse)
    {
      for (Room* room : {&whole, &sparse})
        room->fluoroscope.setVessel(sphere({0.001 * static_cast<double>(pulse), 0.0, 0.0}, 0.02, 12, 12));
      const AngiographyFrame& frame = whole.angiography.draw(pulse, {});
      if (pulse >= 3 && pulse % 2 == 1)
        continue;
      const AngiographyFrame& other = sparse.angiography.draw(pulse, {});
      ASSERT_EQ(frame.native.raw, other.native.raw) << pulse;
      ASSERT_EQ(frame.native.image, other.native.image) << pulse;
      ASSERT_EQ(frame.subtracted, other.subtracted) << pulse;
    }
  }
}

TEST(Angiography, BothDetectorsHaveNoiseOfTheirOwn)
{
  Fluoroscope fluoroscope(pose(), technique(), library());
  Angiography first(fluoroscope), second(fluoroscope, 1);
  const std::vector<std::uint16_t> a = first.draw(5, {}).native.raw;
  EXPECT_EQ(first.draw(5, {}).native.raw, a);
  EXPECT_NE(second.draw(5, {}).native.raw, a);
}

TEST(Angiography, HoldsItsLastImage)
{
  Room room;
  EXPECT_EQ(room.angiography.last(), nullptr);
  const std::vector<std::uint8_t> image = room.draw().native.image;
  room.angiography.begin(XRayMode::kHold);
  ASSERT_NE(room.angiography.last(), nullptr);
  EXPECT_EQ(room.angiography.last()->native.image, image);
}

TEST(Angiography, RefusesWhatIsImpossibleWithARemedy)
{
  Room room;
  Angiography& angiography = room.angiography;
  EXPECT_NE(inputErrorOf([&] { angiography.begin(XRayMode::kSubtraction); }).find("give mask_frames of 1 or more"),
            std::string::npos);
  EXPECT_NE(inputErrorOf([&] { angiography.begin(XRayMode::kRoadmap); }).find("begin one with the mode dsa"),
            std::string::npos);
  EXPECT_THROW(angiography.begin(XRayMode::kLive, 3), InputError);
  EXPECT_THROW(angiography.begin(XRayMode::kSubtraction, 65), InputError);
  EXPECT_THROW(angiography.begin(XRayMode::kSubtraction, -1), InputError);
  EXPECT_THROW(angiography.setShift({0.0, NAN}), InputError);
  EXPECT_THROW(angiography.setShift({65.0, 0.0}), InputError);
  EXPECT_THROW(angiography.setShare(1.1), InputError);
  EXPECT_THROW(angiography.setShare(NAN), InputError);
  EXPECT_EQ(angiography.mode(), XRayMode::kLive);
  EXPECT_THROW(xRayModeOf("DSA"), InputError);
  for (const char* name : {"live", "dsa", "roadmap", "hold"})
    EXPECT_STREQ(nameOf(xRayModeOf(name)), name);
  angiography.begin(XRayMode::kSubtraction, 1);
  EXPECT_THROW(angiography.begin(XRayMode::kRoadmap), InputError);  // no frame yet
  room.draw();
  angiography.begin(XRayMode::kSubtraction);  // with the present mask
  EXPECT_EQ(room.draw().mask, MaskState::kValid);
}

}  // namespace
}  // namespace endovascular_sim::fluoroscopy
