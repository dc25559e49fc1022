#include <gtest/gtest.h>

#include <functional>
#include <string>
#include <vector>

#include <Eigen/Geometry>

#include "image/slice_stack.h"
#include "test/common/input_error_of.h"

namespace endovascular_sim::image
{
namespace
{

using Eigen::Vector3d;

/** Oblique slices in a mixed order. */
std::vector<Slice> obliqueSlices()
{
  const Eigen::Matrix3d axes =
      (Eigen::AngleAxisd(0.3, Vector3d::UnitX()) * Eigen::AngleAxisd(0.2, Vector3d::UnitZ())).toRotationMatrix();
  std::vector<Slice> slices;
  for (const int k : {3, 0, 4, 2, 1})
  {
    Slice slice;
    slice.file = "slice_" + std::to_string(k);
    slice.size = {6, 7};
    slice.spacing = {0.4e-3, 0.5e-3};
    slice.origin = Vector3d(0.01, 0.02, 0.03) + 1.25e-3 * k * axes.col(2);
    slice.along_row = axes.col(0);
    slice.along_column = axes.col(1);
    slices.push_back(slice);
  }
  return slices;
}

/** Message of the rejection of slices after a change; empty without one. */
std::string rejectionAfter(const std::function<void(std::vector<Slice>&)>& change)
{
  std::vector<Slice> slices = obliqueSlices();
  change(slices);
  return inputErrorOf([&] { stackSlices(slices, "folder"); });
}

TEST(SliceStack, OrdersSlicesAlongTheirNormal)
{
  const SliceStack stack = stackSlices(obliqueSlices(), "folder");
  EXPECT_EQ(stack.files, (std::vector<std::string>{"slice_0", "slice_1", "slice_2", "slice_3", "slice_4"}));
  EXPECT_EQ(stack.grid.size, Eigen::Vector3i(6, 7, 5));
  EXPECT_NEAR(stack.grid.spacing.z(), 1.25e-3, 1e-12);
  EXPECT_NEAR((stack.grid.origin - Vector3d(0.01, 0.02, 0.03)).norm(), 0.0, 1e-12);
  EXPECT_NEAR(stack.grid.axes.determinant(), 1.0, 1e-12);
}

TEST(SliceStack, RejectsWhatIsNoRegularGrid)
{
  const auto expect = [](const std::string& words, const std::function<void(std::vector<Slice>&)>& change)
  { EXPECT_NE(rejectionAfter(change).find(words), std::string::npos) << words << " in " << rejectionAfter(change); };
  expect("two or more", [](auto& slices) { slices.resize(1); });
  expect("slices are missing", [](auto& slices) { slices.erase(slices.begin() + 3); });
  expect("is the place of", [](auto& slices) { slices[1].origin = slices[2].origin; });
  expect("pixels", [](auto& slices) { slices[2].size.x() = 5; });
  expect("PixelSpacing", [](auto& slices) { slices[2].spacing.y() *= 1.01; });
  expect("ImageOrientationPatient", [](auto& slices) { slices[2].along_row = Vector3d::UnitX(); });
  expect("gantry tilt of 5.7",
         [](auto& slices)
         {
           for (std::size_t n = 0; n < slices.size(); ++n)
           {
             const double k = slices[n].file.back() - '0';
             slices[n].origin += 0.125e-3 * k * slices[n].along_column;
           }
         });
  EXPECT_EQ(rejectionAfter([](auto&) {}), "");
}

}  // namespace
}  // namespace endovascular_sim::image
