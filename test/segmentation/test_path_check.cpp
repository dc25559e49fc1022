#include "segmentation/path_check.h"

#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "test/common/input_error_of.h"

namespace endovascular_sim::segmentation
{
namespace
{

/** Path through corners [mm] in steps of 0.5 mm, in a lumen of 10 mm; a click at each corner. */
ClickPath pathThrough(const std::vector<Eigen::Vector3d>& corners)
{
  ClickPath path;
  path.points = {1e-3 * corners.front()};
  path.clicks = {0};
  for (std::size_t k = 0; k + 1 < corners.size(); ++k)
  {
    const Eigen::Vector3d step = corners[k + 1] - corners[k];
    const int count = std::max(1, static_cast<int>(step.norm() / 0.5));
    for (int n = 1; n <= count; ++n)
      path.points.push_back(1e-3 * (corners[k] + step * n / count));
    path.clicks.push_back(path.points.size() - 1);
  }
  return path;
}

std::string errorOf(const std::vector<Eigen::Vector3d>& corners, bool is_alone = false)
{
  const ClickPath path = pathThrough(corners);
  CheckedBranch branch;
  branch.name = "LAD";
  for (const std::size_t k : path.clicks)
    branch.clicks.push_back({path.points[k], 350.0, 5e-3});
  return inputErrorOf([&] { requireCourse(path, branch, is_alone, "clicks.yaml"); });
}

TEST(PathCheck, RefusesClicksThatAreNearerThanTheLumenIsWide)
{
  for (const double length : {0.0, 0.3, 2.0, 9.0})
    EXPECT_NE(errorOf({{0, 0, 0}, {0, 0, length}}).find("clicks.yaml: LAD: its clicks are only"), std::string::npos)
        << length;
  EXPECT_NE(errorOf({{0, 0, 0}, {0, 0, 15}}, true), "");
  EXPECT_EQ(errorOf({{0, 0, 0}, {0, 0, 15}}), "");  // e.g. a short left main artery between others
  EXPECT_EQ(errorOf({{0, 0, 0}, {0, 0, 30}}, true), "");
}

TEST(PathCheck, RefusesAPathThatTurnsBackAtAClick)
{
  EXPECT_EQ(errorOf({{0, 0, 0}, {0, 0, 60}, {0, 40, 30}, {0, 40, 0}}), "");  // sharp bends, but no return
  EXPECT_NE(errorOf({{0, 0, 0}, {0, 0, 60}, {0, 0, 30}}).find("turns back at click 2"), std::string::npos);
  EXPECT_NE(errorOf({{0, 0, 0}, {0, 0, 30}, {0, 0, 60}, {0, 1, 35}, {0, 30, 35}}).find("turns back at click 3"),
            std::string::npos);
}

TEST(PathCheck, RefusesALongPathWithItsFarthestPlace)
{
  // No image: nowhere is a lumen of the size of the clicks.
  image::Volume volume;
  volume.grid.size = {4, 4, 4};
  volume.grid.spacing.setConstant(0.05);
  volume.stored.assign(volume.grid.voxels(), 0);
  const Scan scan(volume);
  const auto errorOfPath = [&scan](const std::vector<Eigen::Vector3d>& corners)
  {
    ClickPath path = pathThrough(corners);
    path.clicks = {0, path.points.size() - 1};
    CheckedBranch branch;
    branch.name = "LAD";
    for (const std::size_t k : path.clicks)
      branch.clicks.push_back({path.points[k], 350.0, 5e-3});
    return inputErrorOf([&] { requireDirect(scan, path, branch, "clicks.yaml"); });
  };
  EXPECT_EQ(errorOfPath({{0, 0, 0}, {0, 15, 0}, {0, 15, 40}, {0, 0, 40}}), "");
  const std::string error = errorOfPath({{0, 0, 0}, {0, 60, 0}, {0, 60, 40}, {0, 0, 40}});
  EXPECT_NE(error.find("the path is 160 mm long, 4.0 times the distance of its clicks"), std::string::npos) << error;
  EXPECT_NE(error.find("60.0, "), std::string::npos) << error;
  EXPECT_NE(error.find("add a click between them"), std::string::npos) << error;
}

TEST(PathCheck, AcceptsALoopWhoseArmsLieSideBySide)
{
  EXPECT_EQ(errorOf({{0, 0, 0}, {0, 0, 60}, {0, 11, 60}, {0, 11, 0}}), "");
}

}  // namespace
}  // namespace endovascular_sim::segmentation
