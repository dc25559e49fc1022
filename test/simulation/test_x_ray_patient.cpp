#include "simulation/x_ray_patient.h"

#include <fstream>

#include <gtest/gtest.h>

#include "image/volume_file.h"
#include "scene/scene_file.h"
#include "scene/scene_vessel.h"
#include "test/common/input_error_of.h"

namespace endovascular_sim::simulation
{
namespace
{

scene::Scene tubeWith(const std::string& patient)
{
  return scene::parseScene(
      "vessel: {friction: 0.1, tube: {radius: 0.01, pieces: [{length: 0.1}]}}\n"
      "entry: {position: [0, 0, 0], direction: [0, 0, 1], up: [1, 0, 0]}\n"
      "instrument: {use: guidewire_035_j}\ndrive: {source: topic}\n"
      "fluoroscopy: {pixels: 32, patient: " +
          patient + "}\n",
      "test scene");
}

/** CT with water everywhere and bone in one half. */
std::string ctFile()
{
  image::Volume ct;
  ct.grid.size.setConstant(60);
  ct.grid.spacing.setConstant(3e-3);
  ct.grid.origin = Eigen::Vector3d(-0.09, -0.09, -0.04);
  ct.stored.assign(ct.grid.voxels(), 0);
  for (int k = 0; k < 60; ++k)
    for (int j = 0; j < 60; ++j)
      for (int i = 30; i < 60; ++i)
        ct.stored[ct.grid.offset(i, j, k)] = 900;
  const std::string file = testing::TempDir() + "x_ray_patient.vol";
  image::writeVolume(file, ct);
  return file;
}

vessel::Vessel vesselOf(const scene::Scene& scene)
{
  return scene::buildVessel(*scene.vessel, scene.entry, scene.file, scene::CentrelineUse::kRequired);
}

TEST(XRayPatient, IsAbsentWithoutTheKey)
{
  const scene::Scene scene = tubeWith("none");
  EXPECT_FALSE(loadPatient(scene, vesselOf(scene), kStillResolution).patient);
}

TEST(XRayPatient, OfACtHasItsBoneOnTheSideOfTheCt)
{
  const scene::Scene scene = tubeWith("{ct: " + ctFile() + "}");
  const XRayPatient loaded = loadPatient(scene, vesselOf(scene), kStillResolution);
  ASSERT_TRUE(loaded.patient);
  fluoroscopy::CArmPose pose;
  pose.pixels = 32;
  const fluoroscopy::ArealDensityImage& image = loaded.patient->frame(fluoroscopy::XRayGeometry(pose));
  EXPECT_GT(image.bone[16 * 32 + 22], 10.0F) << "the patient's left is on the right of the image";
  EXPECT_EQ(image.bone[16 * 32 + 8], 0.0F);
}

TEST(XRayPatient, OfADamagedFileIsRefusedByName)
{
  const std::string file = testing::TempDir() + "x_ray_patient_damaged.vol";
  std::ofstream(file) << "no volume";
  const scene::Scene scene = tubeWith("{ct: " + file + "}");
  const std::string message = inputErrorOf([&] { loadPatient(scene, vesselOf(scene), kStillResolution); });
  EXPECT_NE(message.find("x_ray_patient_damaged.vol"), std::string::npos) << message;
}

TEST(XRayPatient, IsRefinedWithinNineTenthsOfASecondAtEveryFrameRate)
{
  for (const double rate : {0.5, 2.0, 7.5, 15.0, 30.0, 60.0})
  {
    const fluoroscopy::ProgressiveResolution resolution = sequenceResolution(rate);
    const int rays = resolution.at_rest * resolution.at_rest;
    const int frames = (rays + resolution.rays_per_frame - 1) / resolution.rays_per_frame;
    EXPECT_GE(resolution.at_rest, 256);
    EXPECT_LE(frames, std::max(1.0, 0.9 * rate)) << rate;
  }
}

}  // namespace
}  // namespace endovascular_sim::simulation
