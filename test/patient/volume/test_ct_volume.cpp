#include "patient/volume/ct_volume.h"

#include <cmath>

#include <gtest/gtest.h>

#include "common/error.h"
#include "patient/tissue/tissue.h"
#include "patient/volume/hounsfield.h"
#include "patient/volume/lumen_mask.h"
#include "test/common/input_error_of.h"
#include "test/fluoroscopy/shapes.h"

namespace endovascular_sim::patient
{
namespace
{

/** CT of water, 60 × 50 × 40 mm about the origin. */
image::Volume water(double spacing)
{
  image::Volume ct;
  ct.grid.spacing.setConstant(spacing);
  ct.grid.size = (Eigen::Vector3d(0.06, 0.05, 0.04) / spacing).array().round().cast<int>();
  ct.grid.origin = -0.5 * spacing * (ct.grid.size.cast<double>().array() - 1.0).matrix();
  ct.stored.assign(ct.grid.voxels(), 0);
  return ct;
}

void setHounsfield(image::Volume& ct, const Eigen::Vector3d& point, std::int16_t number)
{
  const Eigen::Vector3i index = ct.grid.index(point).array().round().cast<int>();
  ct.stored[ct.grid.offset(index.x(), index.y(), index.z())] = number;
}

TEST(CtVolume, HasTheDensitiesOfItsNumbersAtTheirPositions)
{
  image::Volume ct = water(1e-3);
  const Eigen::Vector3d point = ct.grid.position(Eigen::Vector3d(40, 12, 30));
  setHounsfield(ct, point, 1200);
  const PatientVolume patient = ctVolume(ct, Eigen::Isometry3d::Identity(), {}, "ct.vol");
  const Density bone = densityFromHounsfield(1200.0);
  EXPECT_NEAR(patient.volume->interpolate(point).bone, bone.bone, 0.5 * DensityVolume::kBoneStep);
  EXPECT_NEAR(patient.volume->interpolate(point).tissue, bone.tissue, 0.5 * DensityVolume::kTissueStep);
  EXPECT_NEAR(patient.volume->interpolate(-point).tissue, densityFromHounsfield(0.0).tissue, 2.5);
}

TEST(CtVolume, IsMovedByTheRegistration)
{
  image::Volume ct = water(1e-3);
  const Eigen::Vector3d point = ct.grid.position(Eigen::Vector3d(40, 12, 30));
  setHounsfield(ct, point, 1200);
  Eigen::Isometry3d patient_from_ct = Eigen::Isometry3d::Identity();
  patient_from_ct.rotate(Eigen::AngleAxisd(0.7, Eigen::Vector3d(1, 2, 3).normalized()));
  patient_from_ct.pretranslate(Eigen::Vector3d(0.1, -0.2, 0.3));
  const PatientVolume patient = ctVolume(ct, patient_from_ct, {}, "ct.vol");
  EXPECT_NEAR(patient.volume->interpolate(patient_from_ct * point).bone, densityFromHounsfield(1200.0).bone, 4.0);
  EXPECT_NEAR(patient.volume->interpolate(patient_from_ct * -point).bone, 0.0, 4.0);
}

TEST(CtVolume, AveragesVoxelsBelowItsLeastSpacingAndKeepsTheirMassAndCentre)
{
  image::Volume ct = water(0.25e-3);  // blocks of 3 × 3 × 3
  for (int i = 60; i < 63; ++i)
    for (int j = 90; j < 93; ++j)
      for (int k = 30; k < 33; ++k)
        ct.stored[ct.grid.offset(i, j, k)] = static_cast<std::int16_t>(i == 60 ? 900 : 0);
  const PatientVolume patient = ctVolume(ct, Eigen::Isometry3d::Identity(), {}, "ct.vol");
  EXPECT_EQ(patient.volume->grid().size, Eigen::Vector3i(80, 66, 53));
  EXPECT_NEAR(patient.volume->grid().spacing.x(), 0.75e-3, 1e-12);
  EXPECT_NEAR(patient.volume->at(20, 30, 10).bone, densityFromHounsfield(900.0).bone / 3.0, 4.0);
  const Eigen::Vector3d centre = ct.grid.position(Eigen::Vector3d(61, 91, 31));
  EXPECT_LT((patient.volume->grid().position(Eigen::Vector3d(20, 30, 10)) - centre).norm(), 1e-12);
}

TEST(CtVolume, ContrastMediumInTheLumenBecomesBlood)
{
  image::Volume ct = water(1e-3);
  const geometry::TriangleMesh lumen = fluoroscopy::sphere(Eigen::Vector3d(0.01, 0.0, 0.0), 6e-3, 24, 24);
  for (int i = 0; i < ct.grid.size.x(); ++i)
    for (int j = 0; j < ct.grid.size.y(); ++j)
      for (int k = 0; k < ct.grid.size.z(); ++k)
        if ((ct.grid.position(Eigen::Vector3d(i, j, k)) - Eigen::Vector3d(0.01, 0.0, 0.0)).norm() < 6e-3)
          ct.stored[ct.grid.offset(i, j, k)] = 350;
  const PatientVolume patient = ctVolume(ct, Eigen::Isometry3d::Identity(), lumen, "ct.vol");
  EXPECT_NE(patient.notes.at(0).find("100 % of the vessel's wall lies inside the CT"), std::string::npos);
  for (const std::uint16_t voxel : patient.volume->voxels())
    ASSERT_EQ(DensityVolume::decode(voxel).bone, 0.0);
  EXPECT_EQ(patient.volume->interpolate({0.01, 0.0, 0.0}).tissue, propertiesOf(Tissue::kBlood).density);
}

TEST(CtVolume, AVesselBesideTheCtIsRefusedWithBothExtents)
{
  const geometry::TriangleMesh lumen = fluoroscopy::sphere(Eigen::Vector3d(1.0, 0.0, 0.0), 6e-3, 8, 8);
  const std::string message =
      inputErrorOf([&] { ctVolume(water(1e-3), Eigen::Isometry3d::Identity(), lumen, "ct.vol"); });
  EXPECT_NE(message.find("x 0.994 to 1.006"), std::string::npos) << message;
  EXPECT_NE(message.find("the CT x -0.030 to 0.030"), std::string::npos) << message;
}

TEST(CtVolume, AnImageWithoutHounsfieldUnitsIsRefused)
{
  image::Volume mr = water(1e-3);
  mr.modality = image::Modality::kOther;
  EXPECT_THROW(ctVolume(mr, Eigen::Isometry3d::Identity(), {}, "mr.vol"), InputError);
}

}  // namespace
}  // namespace endovascular_sim::patient
