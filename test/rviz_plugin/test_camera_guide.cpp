#include "rviz_plugin/picture/camera_guide.h"

#include <cmath>
#include <limits>

#include <gtest/gtest.h>
#include <Eigen/Geometry>

#include "test/rviz_plugin/moved_patient.h"

namespace endovascular_sim::rviz_plugin
{
namespace
{

constexpr double kFieldOfView = M_PI / 4.0;
constexpr double kFrame = 1.0 / 30.0;

geometry_msgs::Point toPoint(const Eigen::Vector3d& vector)
{
  geometry_msgs::Point point;
  point.x = vector.x();
  point.y = vector.y();
  point.z = vector.z();
  return point;
}

/** Helix of 20 mm radius about the patient's axis, 5 mm wide. */
Eigen::Vector3d onHelix(double turn)
{
  return {0.02 * std::cos(turn), 0.02 * std::sin(turn), 0.02 * turn};
}

VesselCentreline helix()
{
  VesselCentreline message;
  message.branches.resize(1);
  for (int k = 0; k <= 600; ++k)
  {
    message.branches[0].points.push_back(toPoint(onHelix(0.02 * k)));
    message.branches[0].radii.push_back(5e-3);
  }
  return message;
}

RodStateVisual wireTo(double turn)
{
  RodStateVisual message;
  for (double at = 0.0; at <= turn; at += 0.02)
    message.nodes.push_back(toPoint(onHelix(at)));
  return message;
}

TEST(SmoothPoint, DoesNotDependOnTheFrameRate)
{
  SmoothPoint coarse, fine;
  const Eigen::Vector3d target(0.1, -0.2, 0.3);
  for (int k = 0; k < 5; ++k)
    coarse.follow(target, 6.0, 0.1);
  for (int k = 0; k < 50; ++k)
    fine.follow(target, 6.0, 0.01);
  EXPECT_LT((coarse.point() - fine.point()).norm(), 1e-12);
}

TEST(SmoothPoint, ReachesAStepWithoutOvershoot)
{
  SmoothPoint point;
  double last = 0.0;
  for (int k = 0; k < 100; ++k)
  {
    const double at = point.follow(Eigen::Vector3d::UnitX(), 6.0, kFrame).x();
    EXPECT_GE(at, last);
    EXPECT_LE(at, 1.0);
    last = at;
  }
  EXPECT_NEAR(last, 1.0, 1e-6);
}

TEST(CameraGuide, ShowsTheWholeVesselInTheOverview)
{
  CameraGuide guide(ViewMode::kOverview);
  const VesselCentreline vessel = helix();
  guide.setVessel(vessel);
  for (const double aspect : {0.5, 1.0, 1.8})
    for (const double yaw : {0.0, 1.0, 3.0})
    {
      const ViewSetting setting{yaw, 0.3, 0.0};
      CameraPose pose;
      for (int k = 0; k < 200; ++k)
        pose = guide.advance(setting, kFrame, aspect, kFieldOfView);
      const Eigen::Vector3d forward = (pose.focus - pose.eye).normalized(), right = forward.cross(pose.up);
      double largest = 0.0;
      for (const geometry_msgs::Point& message : vessel.branches[0].points)
      {
        const Eigen::Vector3d point = Eigen::Vector3d(message.x, message.y, message.z) - pose.eye;
        const double half = point.dot(forward) * std::tan(0.5 * kFieldOfView);
        largest =
            std::max({largest, std::abs(point.dot(pose.up)) / half, std::abs(point.dot(right)) / (half * aspect)});
      }
      EXPECT_LT(largest, 1.0);
      EXPECT_GT(largest, 0.8);
    }
}

TEST(CameraGuide, LeavesWhatLegendsCoverFreeInTheOverview)
{
  CameraGuide guide(ViewMode::kOverview);
  const VesselCentreline vessel = helix();
  guide.setVessel(vessel);
  for (const double covered : {0.07, 0.2})
    for (const double aspect : {0.4, 1.8})
    {
      CameraPose pose;
      for (int k = 0; k < 200; ++k)
        pose = guide.advance({0.0, 0.1, 0.0, covered}, kFrame, aspect, kFieldOfView);
      const Eigen::Vector3d forward = (pose.focus - pose.eye).normalized();
      double lowest = 1.0, highest = -1.0;  // in the picture, from -1 to 1
      for (const geometry_msgs::Point& message : vessel.branches[0].points)
      {
        const Eigen::Vector3d point = Eigen::Vector3d(message.x, message.y, message.z) - pose.eye;
        const double place = point.dot(pose.up) / (point.dot(forward) * std::tan(0.5 * kFieldOfView));
        lowest = std::min(lowest, place);
        highest = std::max(highest, place);
      }
      EXPECT_GT(lowest, 2.0 * covered - 1.0) << covered << ", " << aspect;
      EXPECT_LT(highest, 1.0) << covered << ", " << aspect;
    }
}

TEST(CameraGuide, FollowsTheTipWithoutRoll)
{
  CameraGuide guide(ViewMode::kFollowTip);
  guide.setVessel(helix());
  CameraPose last;
  for (int k = 0; k < 300; ++k)
  {
    const double turn = 1.0 + 0.03 * k;  // about 25 mm/s
    guide.setWire(wireTo(turn));
    const CameraPose pose = guide.advance({0.4, 0.2, 0.1}, kFrame, 1.5, kFieldOfView);
    const Eigen::Vector3d right = (pose.focus - pose.eye).cross(pose.up);
    EXPECT_NEAR(right.z(), 0.0, 1e-12);
    EXPECT_NEAR((pose.eye - pose.focus).norm(), 0.1, 1e-9);
    if (k > 60)
    {
      EXPECT_LT((pose.focus - onHelix(turn)).norm(), 0.012);  // a lag of two time constants
      EXPECT_LT((pose.eye - last.eye).norm(), 2e-3);
    }
    last = pose;
  }
}

TEST(CameraGuide, LooksAlongTheVesselWithoutRoll)
{
  CameraGuide guide(ViewMode::kAlongVessel);
  guide.setVessel(helix());
  CameraPose last;
  for (int k = 0; k < 300; ++k)
  {
    const double turn = 2.0 + 0.03 * k;
    guide.setWire(wireTo(turn));
    const CameraPose pose = guide.advance({0.0, 0.0, 0.03}, kFrame, 1.5, kFieldOfView);
    const Eigen::Vector3d forward = (pose.focus - pose.eye).normalized();
    EXPECT_NEAR(pose.up.dot(forward), 0.0, 1e-9);
    if (k > 60)
    {
      EXPECT_NEAR((pose.focus - pose.eye).norm(), 0.03, 5e-3);
      // Rotation about the direction of view, per frame [rad].
      const Eigen::Vector3d before = (last.focus - last.eye).normalized();
      const Eigen::Quaterniond least = Eigen::Quaterniond::FromTwoVectors(before, forward);
      EXPECT_LT(((least * last.up) - pose.up).norm(), 2e-3);
      EXPECT_GT(forward.dot(onHelix(turn + 0.02) - onHelix(turn)), 0.0);
    }
    last = pose;
  }
}

TEST(CameraGuide, MovesSmoothlyFromTheEarlierView)
{
  CameraGuide guide(ViewMode::kFollowTip);
  guide.setVessel(helix());
  guide.setWire(wireTo(3.0));
  guide.beginAt({{0.0, -1.0, 0.0}, {0.0, 0.0, 0.0}, Eigen::Vector3d::UnitX()});
  const CameraPose begin = guide.advance({}, 1e-3, 1.5, kFieldOfView);
  EXPECT_LT((begin.eye - Eigen::Vector3d(0.0, -1.0, 0.0)).norm(), 1e-3);
  CameraPose end;
  for (int k = 0; k < 100; ++k)
    end = guide.advance({}, kFrame, 1.5, kFieldOfView);
  EXPECT_LT((end.focus - onHelix(2.98)).norm(), 1e-3);
  EXPECT_GT(end.up.z(), 0.99);
}

TEST(CameraGuide, IgnoresInvalidMessages)
{
  for (const ViewMode mode : {ViewMode::kOverview, ViewMode::kFollowTip, ViewMode::kAlongVessel})
  {
    CameraGuide guide(mode);
    RodStateVisual wire = wireTo(3.0);
    wire.nodes[3].x = std::numeric_limits<double>::quiet_NaN();
    VesselCentreline vessel = helix();
    vessel.branches[0].points[2].z = std::numeric_limits<double>::infinity();
    vessel.branches[0].radii.resize(20);
    guide.setWire(wire);
    guide.setWire({});
    guide.setVessel(vessel);
    guide.setVessel({});
    guide.beginAt({{0.0, 0.0, std::nan("")}, {}, {}});
    for (const double seconds : {kFrame, std::nan(""), -1.0, 1e9})
    {
      const CameraPose pose = guide.advance({}, seconds, 1.5, kFieldOfView);
      EXPECT_TRUE(pose.eye.allFinite() && pose.focus.allFinite() && pose.up.allFinite());
      EXPECT_GT((pose.eye - pose.focus).norm(), 1e-3);
    }
  }
}

/** The wire in a moved patient. */
RodStateVisual moved(RodStateVisual message, const motion::MotionMap& map)
{
  for (geometry_msgs::Point& node : message.nodes)
    node = toPoint(map.position({node.x, node.y, node.z}));
  return message;
}

CameraPose poseOf(ViewMode mode, const motion::MotionMap& map)
{
  CameraGuide guide(mode);
  guide.setVessel(helix());
  guide.setWire(moved(wireTo(9.0), map), map);
  return guide.advance({}, kFrame, 1.5, kFieldOfView);
}

TEST(CameraGuide, StandsStillBehindTheTipWhileThePatientMoves)
{
  const motion::MotionMap map = movedLargePatient();
  EXPECT_GT(map.displacement(onHelix(9.0)).norm(), 5e-3);
  for (const ViewMode mode : {ViewMode::kOverview, ViewMode::kFollowTip})
  {
    const CameraPose rest = poseOf(mode, nodes::restingMap()), pose = poseOf(mode, map);
    EXPECT_LT((pose.eye - rest.eye).norm(), 1e-9);
    EXPECT_LT((pose.focus - rest.focus).norm(), 1e-9);
    EXPECT_LT((pose.up - rest.up).norm(), 1e-9);
  }
}

TEST(CameraGuide, MovesAlongTheVesselWithThePatient)
{
  const motion::MotionMap map = movedLargePatient();
  const CameraPose rest = poseOf(ViewMode::kAlongVessel, nodes::restingMap()),
                   pose = poseOf(ViewMode::kAlongVessel, map);
  EXPECT_LT((pose.eye - map.position(rest.eye)).norm(), 1e-9);
  EXPECT_LT((pose.focus - map.position(rest.focus)).norm(), 1e-9);
  EXPECT_GT((pose.eye - rest.eye).norm(), 5e-3);
  EXPECT_NEAR(pose.up.norm(), 1.0, 1e-12);
  EXPECT_NEAR(pose.up.dot((pose.focus - pose.eye).normalized()), 0.0, 1e-9);
}

TEST(CameraGuide, BeginsAlongTheVesselWhereTheCameraIs)
{
  const motion::MotionMap map = movedLargePatient();
  CameraGuide guide(ViewMode::kAlongVessel);
  guide.setVessel(helix());
  guide.setWire(moved(wireTo(9.0), map), map);
  const CameraPose begin{{0.02, -0.1, 0.1}, {0.0, 0.0, 0.1}, Eigen::Vector3d::UnitZ()};
  guide.beginAt(begin);
  const CameraPose pose = guide.advance({}, 0.0, 1.5, kFieldOfView);
  EXPECT_LT((pose.eye - begin.eye).norm(), 1e-9);
  EXPECT_LT((pose.focus - begin.focus).norm(), 1e-9);
}

}  // namespace
}  // namespace endovascular_sim::rviz_plugin
