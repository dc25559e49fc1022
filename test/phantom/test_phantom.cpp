#include "phantom/phantom.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "common/error.h"
#include "patient/body/body_model.h"
#include "patient/volume/hounsfield.h"
#include "phantom/true_clicks.h"
#include "vessel/anatomy/anatomy_mesh.h"
#include "vessel/anatomy/implicit_vessel.h"

namespace endovascular_sim::phantom
{
namespace
{

vessel::Anatomy fork()
{
  return vessel::readAnatomy(std::string(PROJECT_DIR) + "/config/anatomies/fork.yaml");
}
vessel::Anatomy body()
{
  return vessel::readAnatomy(std::string(PROJECT_DIR) + "/config/anatomies/plain.yaml");
}

/** The fork in a box of 0.6 mm voxels. */
PhantomSettings forkSettings()
{
  PhantomSettings settings;
  settings.grid = gridOfBox({-0.03, -0.012, -0.01}, {0.034, 0.017, 0.1}, Eigen::Vector3d::Constant(6e-4));
  settings.threads = 2;
  return settings;
}

/** Mean of the voxels between two distances from the wall, and their standard deviation. */
std::pair<double, double> statistics(const image::Volume& volume, double least, double most)
{
  const vessel::ImplicitVessel field(fork(), vessel::sampleChains(fork()));
  double sum = 0.0;
  double square = 0.0;
  double n = 0.0;
  for (int k = 0; k < volume.grid.size.z(); ++k)
    for (int j = 0; j < volume.grid.size.y(); ++j)
      for (int i = 0; i < volume.grid.size.x(); ++i)
      {
        const double d = field.at(volume.grid.position(Eigen::Vector3d(i, j, k))).distance;
        if (d < least || d > most)
          continue;
        const double value = volume.at(i, j, k);
        sum += value;
        square += value * value;
        n += 1.0;
      }
  return {sum / n, std::sqrt(square / n - sum * sum / n / n)};
}

TEST(Phantom, HasTheSameBitsWithAnyNumberOfThreads)
{
  PhantomSettings settings = forkSettings();
  const image::Volume one = makePhantom(fork(), settings);
  settings.threads = 4;
  EXPECT_EQ(makePhantom(fork(), settings).stored, one.stored);
  settings.seed = 2;
  EXPECT_NE(makePhantom(fork(), settings).stored, one.stored);
}

TEST(Phantom, HasTheValuesOfItsTissuesAndTheNoiseOfItsSettings)
{
  const image::Volume volume = makePhantom(fork(), forkSettings());
  const auto [lumen, lumen_noise] = statistics(volume, -0.004, -0.0014);
  EXPECT_NEAR(lumen, 400.0, 1.0);
  EXPECT_NEAR(lumen_noise, 25.0, 1.0);
  const auto [fat, fat_noise] = statistics(volume, 0.003, 0.01);
  EXPECT_NEAR(fat, -98.0, 0.5);
  EXPECT_NEAR(fat_noise, 25.0, 0.3);
}

// The value at the edge of a plane wall: half of the step from the lumen to the wall, less the fat behind the wall,
// whose share is Φ(−w/σ). The curvature of a vessel of 3.5 to 4 mm changes it by some HU.
TEST(Phantom, HasTheValueOfABlurredEdgeAtTheWall)
{
  PhantomSettings settings = forkSettings();
  settings.noise = 0.0;
  settings.grid = gridOfBox({-0.006, -0.006, 0.01}, {0.006, 0.008, 0.03}, Eigen::Vector3d::Constant(2e-4));
  const image::Volume volume = makePhantom(fork(), settings);
  const double share = 0.5 * std::erfc(settings.wall_thickness / settings.point_spread / std::sqrt(2.0));
  EXPECT_NEAR(statistics(volume, -2e-5, 2e-5).first, 0.5 * (400.0 + 60.0) - 158.0 * share, 12.0);
}

TEST(Phantom, OfMagneticResonanceHasASignalThatFallsTowardsTheFeet)
{
  PhantomSettings settings;
  settings.modality = image::Modality::kOther;
  settings.noise = 0.0;
  settings.grid = gridOfBox({-0.02, -0.02, 0.0}, {0.04, 0.06, 0.24}, Eigen::Vector3d::Constant(4e-3));
  const image::Volume volume = makePhantom(body(), settings);
  const auto at = [&](const Eigen::Vector3d& p)
  {
    const Eigen::Vector3d index = (p - volume.grid.origin).cwiseQuotient(volume.grid.spacing);
    return volume.at(static_cast<int>(std::lround(index.x())), static_cast<int>(std::lround(index.y())),
                     static_cast<int>(std::lround(index.z())));
  };
  EXPECT_GT(at({0.0235, 0.0445, 0.21}), 1.2 * at({0.005, 0.014, 0.067}));
}

TEST(Phantom, OfTheNaturalAnatomyHasTheBodyOfItsXRayImages)
{
  const vessel::Vessel natural = vessel::loadAnatomy(std::string(PROJECT_DIR) + "/config/anatomies/natural.yaml", "");
  const patient::PatientVolume patient = patient::makeBody(natural, {2.5e-3, 1});
  const vessel::Anatomy anatomy = vessel::readAnatomy(std::string(PROJECT_DIR) + "/config/anatomies/natural.yaml");
  const vessel::ImplicitVessel field(anatomy, vessel::sampleChains(anatomy));
  PhantomSettings settings;
  settings.noise = 0.0;
  settings.grid = gridOfBox({-0.15, -0.12, 0.0}, {0.15, 0.12, 0.1}, Eigen::Vector3d::Constant(5e-3));
  const image::Volume ct = makePhantom(anatomy, settings);
  double bones = 0.0;
  double wrong = 0.0;
  double count = 0.0;
  for (int k = 0; k < ct.grid.size.z(); ++k)
    for (int j = 0; j < ct.grid.size.y(); ++j)
      for (int i = 0; i < ct.grid.size.x(); ++i)
      {
        const Eigen::Vector3d p = ct.grid.position(Eigen::Vector3d(i, j, k));
        if (field.at(p).distance < 8e-3)
          continue;
        const double expected = patient::hounsfieldOf(patient.volume->interpolate(p));
        wrong += std::abs(ct.at(i, j, k) - expected) > 150.0 ? 1.0 : 0.0;  // edges are as wide as a voxel
        bones += expected > 200.0 ? 1.0 : 0.0;
        count += 1.0;
      }
  EXPECT_GT(bones, 0.01 * count);
  EXPECT_LT(wrong, 0.05 * count);
}

TEST(Phantom, HasContrastMediumInTheChambersOfEveryHeartButNotBesideItsArteries)
{
  for (const std::string name : {"plain", "natural"})
  {
    const vessel::Anatomy anatomy =
        vessel::readAnatomy(std::string(PROJECT_DIR) + "/config/anatomies/" + name + ".yaml");
    const vessel::ImplicitVessel field(anatomy, vessel::sampleChains(anatomy));
    PhantomSettings settings;
    settings.noise = 0.0;
    settings.grid = gridOfBox({-0.06, -0.07, 0.09}, {0.08, 0.02, 0.22}, Eigen::Vector3d::Constant(2e-3));
    const image::Volume ct = makePhantom(anatomy, settings);
    const auto at = [&](const Eigen::Vector3d& p)
    {
      const Eigen::Vector3i voxel = ct.grid.index(p).array().round().cast<int>();
      return ct.at(voxel.x(), voxel.y(), voxel.z());
    };
    double ventricle = 0.0;
    double beside = 0.0;
    for (int k = 0; k < ct.grid.size.z(); ++k)
      for (int j = 0; j < ct.grid.size.y(); ++j)
        for (int i = 0; i < ct.grid.size.x(); ++i)
        {
          const double distance = field.at(ct.grid.position(Eigen::Vector3d(i, j, k))).distance;
          ventricle += ct.at(i, j, k) == 380 ? 1.0 : 0.0;
          beside = distance > 2.9e-3 && distance < 3.1e-3 ? std::max(beside, ct.at(i, j, k)) : beside;
        }
    EXPECT_NEAR(1e6 * 8e-9 * ventricle, 170.0, 60.0) << name << ": volume of the left ventricle [ml]";
    EXPECT_LT(beside, 300.0) << name;
    EXPECT_NEAR(at({0.008, 0.012, 0.172}), 360.0, 1.0) << name << ": left atrium";
    EXPECT_NEAR(at({-0.018, -0.052, 0.147}), 210.0, 1.0) << name << ": right ventricle";
  }
}

TEST(Phantom, RefusesSettingsOutOfRange)
{
  PhantomSettings settings = forkSettings();
  settings.noise = NAN;
  EXPECT_THROW(makePhantom(fork(), settings), InputError);
  settings = forkSettings();
  settings.point_spread = 0.1;
  EXPECT_THROW(makePhantom(fork(), settings), InputError);
}

TEST(TrueClicks, LieInTheLumenOfTheirBranch)
{
  const vessel::Anatomy anatomy = body();
  const vessel::ImplicitVessel field(anatomy, vessel::sampleChains(anatomy));
  const Eigen::AlignedBox3d heart(Eigen::Vector3d(-0.048, -0.1, 0.092), Eigen::Vector3d(0.09, 0.046, 0.228));
  for (const std::uint64_t seed : {1, 2, 3})
  {
    const std::vector<BranchClicks> clicks =
        trueClicks(anatomy, {"left_anterior_descending", "left_circumflex", "right_coronary"}, heart, seed);
    ASSERT_EQ(clicks.size(), 3u);
    for (const BranchClicks& branch : clicks)
      for (const Eigen::Vector3d& p : branch.points)
        EXPECT_LT(field.at(p).distance, -3e-4) << branch.name;
  }
  EXPECT_THROW(trueClicks(anatomy, {"left_subclavian"}, heart, 1), InputError);
  EXPECT_THROW(trueClicks(anatomy, {"vertebral"}, heart, 1), InputError);
}

TEST(TrueClicks, WithoutNamesFormOneTree)
{
  // The abdomen up to the heart's lower border: the right coronary artery is in view, its parent is not.
  const Eigen::AlignedBox3d abdomen(Eigen::Vector3d(-0.095, -0.06, -0.15), Eigen::Vector3d(0.095, 0.08, 0.11));
  std::vector<std::string> names;
  for (const BranchClicks& branch : trueClicks(body(), {}, abdomen, 1))
    names.push_back(branch.name);
  const std::vector<std::string> tree = {"abdominal_aorta", "left_common_iliac", "left_external_iliac",
                                         "right_common_iliac", "right_external_iliac"};
  EXPECT_EQ(names, tree);
}

}  // namespace
}  // namespace endovascular_sim::phantom
