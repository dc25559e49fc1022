#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include <diagnostic_msgs/DiagnosticArray.h>
#include <ros/ros.h>
#include <sensor_msgs/CameraInfo.h>
#include <sensor_msgs/Image.h>
#include <tf2_msgs/TFMessage.h>
#include <tf2_ros/buffer.h>
#include <tf2_ros/transform_listener.h>

#include "endovascular_sim/CArm.h"
#include "endovascular_sim/RodStateVisual.h"
#include "endovascular_sim/VesselMesh.h"
#include "geometry/triangle_mesh.h"
#include "nodes/conversions/contact_conversions.h"
#include "nodes/conversions/image_conversions.h"
#include "nodes/runtime/ros_names.h"
#include "scene/model/scene.h"

namespace endovascular_sim::nodes
{
namespace
{

const Eigen::Vector3d kTip(0.011, 0.004, 0.05);

/** Vessel in the shape of a box, 30 mm wide and 100 mm long, centred at (0, 0, 0.05). */
VesselMesh boxVessel()
{
  VesselMesh message;
  message.version = 1;
  for (int i = 0; i < 8; ++i)
  {
    geometry_msgs::Point corner;
    corner.x = (i & 1) != 0 ? 0.015 : -0.015;
    corner.y = (i & 2) != 0 ? 0.015 : -0.015;
    corner.z = (i & 4) != 0 ? 0.1 : 0.0;
    message.mesh.vertices.push_back(corner);
  }
  const std::uint32_t faces[12][3] = {{0, 2, 1}, {1, 2, 3}, {4, 5, 6}, {5, 7, 6}, {0, 1, 4}, {1, 5, 4},
                                      {2, 6, 3}, {3, 6, 7}, {0, 4, 2}, {2, 4, 6}, {1, 3, 5}, {3, 7, 5}};
  for (const auto& face : faces)
  {
    shape_msgs::MeshTriangle triangle;
    std::copy(face, face + 3, triangle.vertex_indices.begin());
    message.mesh.triangles.push_back(triangle);
  }
  geometry::TriangleMesh mesh;
  for (const geometry_msgs::Point& corner : message.mesh.vertices)
    mesh.vertices.push_back(fromMessage(corner));
  for (const auto& face : faces)
    mesh.triangles.emplace_back(static_cast<int>(face[0]), static_cast<int>(face[1]), static_cast<int>(face[2]));
  message.content_hash = mesh.hash();
  return message;
}

/** Straight thick wire along z that ends at kTip. */
RodStateVisual rod()
{
  RodStateVisual state;
  for (int i = 0; i <= 40; ++i)
  {
    geometry_msgs::Point node;
    node.x = kTip.x();
    node.y = kTip.y();
    node.z = kTip.z() - 0.001 * (40 - i);
    state.nodes.push_back(node);
    state.radius.push_back(0.9e-3);
  }
  state.contact_force.resize(state.nodes.size());
  state.insertion = {0.04};
  state.rotation = state.tip_rotation = state.hand_force = state.hand_torque = state.pressure = {0.0};
  return state;
}

bool waitFor(const std::function<bool()>& condition)
{
  const ros::SteadyTime end = ros::SteadyTime::now() + ros::WallDuration(15.0);
  while (ros::ok() && ros::SteadyTime::now() < end)
  {
    ros::spinOnce();
    if (condition())
      return true;
    ros::WallDuration(0.01).sleep();
  }
  return false;
}

class FluoroscopyGraph : public testing::Test
{
protected:
  FluoroscopyGraph()
    : listener_(buffer_),
      mesh_(node_.advertise<VesselMesh>(names::kVesselMesh, 1, true)),
      rod_(node_.advertise<RodStateVisual>(names::kRodStateVisual, 1, true)),
      c_arm_(node_.advertise<CArm>(names::kCArmCommand, 1)),
      diagnostics_(node_.subscribe<diagnostic_msgs::DiagnosticArray>(names::kDiagnostics, 10,
                                                                     &FluoroscopyGraph::receiveDiagnostics, this))
  {
    mesh_.publish(boxVessel());
    rod_.publish(rod());
  }

  void subscribe()
  {
    const auto keep = [](auto& map) { return [&map](const auto& message) { map[message->header.stamp] = message; }; };
    image_ = node_.subscribe<sensor_msgs::Image>(names::kFluoroscopyImage, 10, keep(images));
    raw_ = node_.subscribe<sensor_msgs::Image>(names::kFluoroscopyRaw, 10, keep(raws));
    info_ = node_.subscribe<sensor_msgs::CameraInfo>(names::kFluoroscopyCameraInfo, 10, keep(infos));
  }

  void clearFrames()
  {
    images.clear();
    raws.clear();
    infos.clear();
  }

  /** Stamp of a frame whose images and camera info have arrived. */
  std::optional<ros::Time> completeFrame()
  {
    std::optional<ros::Time> found;
    waitFor(
        [&]
        {
          for (const auto& [stamp, info] : infos)
            if (images.count(stamp) > 0 && raws.count(stamp) > 0)
              found = stamp;
          return found.has_value();
        });
    return found;
  }

  /** Pixel (column, row) of a point in the patient frame, from tf and camera_info. */
  Eigen::Vector2d pixelOf(const Eigen::Vector3d& point, const sensor_msgs::CameraInfo& info)
  {
    const auto t = buffer_.lookupTransform(info.header.frame_id, names::kPatientFrame, ros::Time(0)).transform;
    const Eigen::Quaterniond turn(t.rotation.w, t.rotation.x, t.rotation.y, t.rotation.z);
    const Eigen::Vector3d p = turn * point + Eigen::Vector3d(t.translation.x, t.translation.y, t.translation.z);
    const Eigen::Vector3d image = Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(info.K.data()) * p;
    return image.hnormalized();
  }

  /** Mean grey value of 3 × 3 pixels. */
  static double grey(const sensor_msgs::Image& image, const Eigen::Vector2d& pixel)
  {
    double sum = 0.0;
    for (long row = std::lround(pixel.y()) - 1; row <= std::lround(pixel.y()) + 1; ++row)
      for (long column = std::lround(pixel.x()) - 1; column <= std::lround(pixel.x()) + 1; ++column)
        sum += image.data.at(static_cast<std::size_t>(row) * image.step + static_cast<std::size_t>(column));
    return sum / 9.0;
  }

  /** Expects the wire 10 mm below the tip, and no wire 10 mm above or 3 mm beside it. */
  void expectWireAtItsProjection(const ros::Time& stamp)
  {
    expectWireAtItsProjection(*infos.at(stamp), *images.at(stamp));
  }

  void expectWireAtItsProjection(const sensor_msgs::CameraInfo& info, const sensor_msgs::Image& image)
  {
    const Eigen::Vector3d along(0.0, 0.0, 0.01), beside(0.003, 0.0, 0.0);
    const double wire = grey(image, pixelOf(kTip - along, info));
    EXPECT_LT(wire, grey(image, pixelOf(kTip + along, info)) - 30);
    EXPECT_LT(wire, grey(image, pixelOf(kTip - along + beside, info)) - 30);
    EXPECT_LT(wire, grey(image, pixelOf(kTip - along - beside, info)) - 30);
  }

  void command(const CArm& message)
  {
    ASSERT_TRUE(waitFor([&] { return c_arm_.getNumSubscribers() > 0; }));
    c_arm_.publish(message);
  }

  void commandView(const std::string& view)
  {
    CArm message;
    message.view = view;
    command(message);
  }

  bool isRefused(const std::string& part)
  {
    return waitFor([&] { return status_message.find(part) != std::string::npos; });
  }

  /** Direction from the source to the detector in the patient frame, from tf. */
  Eigen::Vector3d forward()
  {
    const auto t = buffer_.lookupTransform(names::kPatientFrame, names::kXRaySourceFrame, ros::Time(0)).transform;
    return Eigen::Quaterniond(t.rotation.w, t.rotation.x, t.rotation.y, t.rotation.z) * Eigen::Vector3d::UnitZ();
  }

  bool looksAlong(double primary, double secondary)
  {
    const double a = primary * M_PI / 180.0, b = secondary * M_PI / 180.0;
    const Eigen::Vector3d expected(std::sin(a) * std::cos(b), -std::cos(a) * std::cos(b), std::sin(b));
    return waitFor(
        [&]
        {
          return buffer_.canTransform(names::kPatientFrame, names::kXRaySourceFrame, ros::Time(0)) &&
                 (forward() - expected).norm() < 1e-9;
        });
  }

  std::map<ros::Time, sensor_msgs::ImageConstPtr> images, raws;
  std::map<ros::Time, sensor_msgs::CameraInfoConstPtr> infos;
  std::map<std::string, std::string> status;
  std::string status_message;
  int status_count = 0;

  ros::NodeHandle node_;
  tf2_ros::Buffer buffer_;
  tf2_ros::TransformListener listener_;
  ros::Publisher mesh_, rod_, c_arm_;
  ros::Subscriber diagnostics_, image_, raw_, info_;

private:
  void receiveDiagnostics(const diagnostic_msgs::DiagnosticArrayConstPtr& message)
  {
    for (const auto& candidate : message->status)
      if (candidate.hardware_id == "simulated C-arm")
      {
        status.clear();
        for (const auto& value : candidate.values)
          status[value.key] = value.value;
        status_message = candidate.message;
        ++status_count;
      }
  }
};

TEST_F(FluoroscopyGraph, RendersNothingWithoutASubscriberAndReportsItsScheduling)
{
  ASSERT_TRUE(waitFor([&] { return status_message == "idle: no subscriber"; })) << status_message;
  const int count = status_count;
  ASSERT_TRUE(waitFor([&] { return status_count > count + 1; }));
  EXPECT_EQ(status.at("frames rendered"), "0");
  EXPECT_NE(status.at("scheduling").find("SCHED_IDLE"), std::string::npos);
}

TEST_F(FluoroscopyGraph, PublishesImagesAndCameraInfoWithOneStampWhileTheyHaveSubscribers)
{
  subscribe();
  const auto stamp = completeFrame();
  ASSERT_TRUE(stamp);
  EXPECT_EQ(images.at(*stamp)->encoding, "mono8");
  EXPECT_EQ(raws.at(*stamp)->encoding, "mono16");
  EXPECT_EQ(raws.at(*stamp)->data.size(), 256U * 256U * 2U);
  const sensor_msgs::CameraInfo& info = *infos.at(*stamp);
  EXPECT_EQ(info.header.frame_id, names::kXRaySourceFrame);
  EXPECT_EQ(images.at(*stamp)->header.frame_id, names::kXRaySourceFrame);
  EXPECT_DOUBLE_EQ(info.K[0], 1.2 / (0.3 / 256));
  EXPECT_DOUBLE_EQ(info.P[0], info.K[0]);
  EXPECT_DOUBLE_EQ(info.P[5], info.K[4]);
  image_.shutdown();
  raw_.shutdown();
  info_.shutdown();
  EXPECT_TRUE(waitFor([&] { return status_message == "idle: no subscriber"; }));
}

TEST_F(FluoroscopyGraph, DrawsTheWireAtItsProjectionByTfAndCameraInfo)
{
  subscribe();
  const auto stamp = completeFrame();
  ASSERT_TRUE(stamp);
  // The wire is left of the vessel's axis; the patient's left is on the right of the image.
  EXPECT_GT(pixelOf(kTip, *infos.at(*stamp)).x(), infos.at(*stamp)->K[2] + 5.0);
  expectWireAtItsProjection(*stamp);
}

TEST_F(FluoroscopyGraph, FollowsCommandsOfTheCArmAndRejectsInvalidOnes)
{
  subscribe();
  ASSERT_TRUE(completeFrame());
  fluoroscopy::CArmPose pose;
  pose.primary_angle = 0.7;
  pose.secondary_angle = 0.3;
  pose.isocentre = {0.0, 0.0, 0.04};
  ASSERT_TRUE(waitFor([&] { return c_arm_.getNumSubscribers() > 0; }));
  c_arm_.publish(toMessage(pose));
  const Eigen::Vector3d source = fluoroscopy::XRayGeometry(pose).source();
  const auto isSourceInPlace = [&]
  {
    const auto t = buffer_.lookupTransform(names::kPatientFrame, names::kXRaySourceFrame, ros::Time(0)).transform;
    return (Eigen::Vector3d(t.translation.x, t.translation.y, t.translation.z) - source).norm() < 1e-9;
  };
  ASSERT_TRUE(waitFor(isSourceInPlace));
  clearFrames();
  ASSERT_TRUE(completeFrame());
  clearFrames();  // a frame rendered during the motion may show the old pose
  const auto stamp = completeFrame();
  ASSERT_TRUE(stamp);
  expectWireAtItsProjection(*stamp);

  pose.source_to_patient = 2.0;
  c_arm_.publish(toMessage(pose));
  EXPECT_TRUE(isRefused("distance_source_to_patient: is 2 m, beyond the gantry; must lie between 0.6 and 0.9 m"));
  EXPECT_TRUE(isSourceInPlace());
}

TEST_F(FluoroscopyGraph, MovesTheCArmAtItsSpeedAlsoWithoutASubscriber)
{
  ASSERT_TRUE(
      waitFor([&] { return buffer_.canTransform(names::kPatientFrame, names::kXRaySourceFrame, ros::Time(0)); }));
  commandView("RAO 20");
  ASSERT_TRUE(looksAlong(-20, 0));
  const ros::SteadyTime begin = ros::SteadyTime::now();
  commandView("LAO 30 CRA 10");
  ASSERT_TRUE(waitFor([&] { return std::atan2(forward().x(), -forward().y()) > 0.0; }));
  const double seconds = (ros::SteadyTime::now() - begin).toSec();
  EXPECT_GT(seconds, 20.0 / 25.0 - 0.1);
  EXPECT_LT(seconds, 20.0 / 25.0 + 3.0);
  EXPECT_TRUE(looksAlong(30, 10));
  EXPECT_GT((ros::SteadyTime::now() - begin).toSec(), 50.0 / 25.0 - 0.1);
}

TEST_F(FluoroscopyGraph, PublishesItsPoseAtALowRateAtRest)
{
  int poses = 0;
  const ros::Subscriber tf =
      node_.subscribe<tf2_msgs::TFMessage>("/tf", 100,
                                           [&poses](const tf2_msgs::TFMessageConstPtr& message)
                                           {
                                             for (const auto& transform : message->transforms)
                                               poses += transform.child_frame_id == names::kXRaySourceFrame;
                                           });
  ASSERT_TRUE(waitFor([&] { return poses > 0; }));
  poses = 0;
  const ros::SteadyTime end = ros::SteadyTime::now() + ros::WallDuration(3.0);
  while (ros::SteadyTime::now() < end)
  {
    ros::spinOnce();
    ros::WallDuration(0.01).sleep();
  }
  EXPECT_GE(poses, 2);
  EXPECT_LE(poses, 8);
}

TEST_F(FluoroscopyGraph, RefusesCommandsBeyondItsLimitsAndRetainsItsTarget)
{
  commandView("LAO 30 CRA 10");
  ASSERT_TRUE(looksAlong(30, 10));
  commandView("sipder");
  EXPECT_TRUE(isRefused("view: unknown view 'sipder'; known: AP, lateral, spider"));
  commandView("CRA 60");
  EXPECT_TRUE(isRefused("positioner_secondary_angle: is 1.047 rad (60°)"));
  CArm message;
  message.positioner_primary_angle = std::numeric_limits<double>::quiet_NaN();
  command(message);
  EXPECT_TRUE(isRefused("positioner_primary_angle"));
  EXPECT_TRUE(looksAlong(30, 10));
}

TEST_F(FluoroscopyGraph, PublishesTheSourceViewWithPositiveFocalLengths)
{
  std::map<ros::Time, sensor_msgs::ImageConstPtr> views;
  std::map<ros::Time, sensor_msgs::CameraInfoConstPtr> cameras;
  const ros::Subscriber image = node_.subscribe<sensor_msgs::Image>(
      names::kSourceViewImage, 10, [&views](const sensor_msgs::ImageConstPtr& m) { views[m->header.stamp] = m; });
  const ros::Subscriber info = node_.subscribe<sensor_msgs::CameraInfo>(
      names::kSourceViewCameraInfo, 10,
      [&cameras](const sensor_msgs::CameraInfoConstPtr& m) { cameras[m->header.stamp] = m; });
  commandView("LAO 30 CRA 10");
  ASSERT_TRUE(looksAlong(30, 10));
  subscribe();
  std::optional<ros::Time> stamp;
  ASSERT_TRUE(waitFor(
      [&]
      {
        for (const auto& [time, camera] : cameras)
          if (views.count(time) > 0 && images.count(time) > 0)
            stamp = time;
        return stamp.has_value();
      }));
  const sensor_msgs::CameraInfo& camera = *cameras.at(*stamp);
  EXPECT_EQ(camera.header.frame_id, names::kXRaySourceViewFrame);
  EXPECT_GT(camera.K[0], 0.0);
  EXPECT_DOUBLE_EQ(camera.K[4], camera.K[0]);
  EXPECT_DOUBLE_EQ(camera.P[5], camera.K[0]);
  ASSERT_TRUE(
      waitFor([&] { return buffer_.canTransform(camera.header.frame_id, names::kPatientFrame, ros::Time(0)); }));
  expectWireAtItsProjection(camera, *views.at(*stamp));
  const sensor_msgs::Image& view = *views.at(*stamp);
  const sensor_msgs::Image& radiograph = *images.at(*stamp);
  for (std::size_t row = 0; row < 256; row += 51)
    for (std::size_t column = 0; column < 256; ++column)
      ASSERT_EQ(view.data[row * view.step + column], radiograph.data[row * view.step + 255 - column]);
}

TEST_F(FluoroscopyGraph, RejectsInconsistentMessagesAndContinues)
{
  subscribe();
  VesselMesh mesh = boxVessel();
  mesh.mesh.triangles[3].vertex_indices[1] = 8;
  mesh_.publish(mesh);
  EXPECT_TRUE(waitFor([&] { return status_message.find("triangle 3") != std::string::npos; }));
  RodStateVisual state = rod();
  state.insertion.clear();
  rod_.publish(state);
  EXPECT_TRUE(waitFor([&] { return status_message.find("insertion") != std::string::npos; }));
  clearFrames();
  EXPECT_TRUE(completeFrame());
}

TEST(ImageConversions, RestoreACArmPose)
{
  fluoroscopy::CArmPose pose;
  pose.primary_angle = -0.4;
  pose.secondary_angle = 0.2;
  pose.source_to_detector = 1.1;
  pose.source_to_patient = 0.8;
  pose.isocentre = {1.0, 2.0, 3.0};
  pose.detector_width = 0.2;
  pose.pixels = 100;
  pose.field_width = 0.1;
  pose.field_height = 0.15;
  fluoroscopy::CArmPose present;
  present.pixels = 100;
  EXPECT_EQ(toPose(toMessage(pose), present), pose);
}

TEST(ImageConversions, AViewRetainsQuantitiesThatAreZero)
{
  fluoroscopy::CArmPose present;
  present.isocentre = {1.0, 2.0, 3.0};
  present.source_to_detector = 1.1;
  CArm message;
  message.view = "RAO 30 CAU 20";
  message.positioner_primary_angle = 1.0;
  fluoroscopy::CArmPose expected = present;
  expected.primary_angle = -30.0 / 180.0 * M_PI;
  expected.secondary_angle = -20.0 / 180.0 * M_PI;
  EXPECT_EQ(toPose(message, present), expected);
  message.distance_source_to_detector = 1.0;
  message.isocentre.z = 0.5;
  expected.source_to_detector = 1.0;
  expected.isocentre = {0.0, 0.0, 0.5};
  EXPECT_EQ(toPose(message, present), expected);
}

}  // namespace
}  // namespace endovascular_sim::nodes
