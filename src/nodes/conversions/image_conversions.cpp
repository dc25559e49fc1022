#include "nodes/conversions/image_conversions.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <string>

#include <sensor_msgs/image_encodings.h>

#include "common/error.h"
#include "fluoroscopy/gantry/view.h"
#include "nodes/conversions/contact_conversions.h"
#include "nodes/conversions/message_checks.h"
#include "nodes/runtime/ros_names.h"

namespace endovascular_sim::nodes
{
namespace
{

template <typename Pixel>
sensor_msgs::Image image(const std_msgs::Header& header, int pixels, const std::vector<Pixel>& values,
                         const std::string& encoding)
{
  sensor_msgs::Image message;
  message.header = header;
  message.width = message.height = static_cast<std::uint32_t>(pixels);
  message.encoding = encoding;
  message.is_bigendian = 0;
  message.step = static_cast<std::uint32_t>(static_cast<std::size_t>(pixels) * sizeof(Pixel));
  message.data.resize(values.size() * sizeof(Pixel));
  std::memcpy(message.data.data(), values.data(), message.data.size());
  return message;
}

sensor_msgs::CameraInfo cameraInfo(const std_msgs::Header& header, int pixels, const Eigen::Matrix3d& k)
{
  sensor_msgs::CameraInfo info;
  info.header = header;
  info.width = info.height = static_cast<std::uint32_t>(pixels);
  info.distortion_model = "plumb_bob";
  info.D.assign(5, 0.0);
  std::size_t i = 0, j = 0;  // row-major indices into K and R, and into P
  for (int row = 0; row < 3; ++row, ++j)
    for (int column = 0; column < 3; ++column, ++i, ++j)
    {
      info.K[i] = info.P[j] = k(row, column);
      info.R[i] = row == column ? 1.0 : 0.0;
    }
  return info;
}

}  // namespace

sensor_msgs::Image toImage(const std_msgs::Header& header, int pixels, const std::vector<std::uint8_t>& grey)
{
  return image(header, pixels, grey, sensor_msgs::image_encodings::MONO8);
}

sensor_msgs::Image toImage(const std_msgs::Header& header, int pixels, const std::vector<std::uint16_t>& signal)
{
  return image(header, pixels, signal, sensor_msgs::image_encodings::MONO16);
}

sensor_msgs::Image mirrored(const sensor_msgs::Image& image)
{
  sensor_msgs::Image result = image;
  const std::size_t size = image.step / image.width;  // of a pixel
  for (std::size_t row = 0; row < image.height; ++row)
    for (std::size_t column = 0; column < image.width; ++column)
      std::memcpy(result.data.data() + row * image.step + column * size,
                  image.data.data() + row * image.step + (image.width - 1 - column) * size, size);
  return result;
}

sensor_msgs::CameraInfo toCameraInfo(const std_msgs::Header& header, const fluoroscopy::XRayGeometry& geometry)
{
  return cameraInfo(header, geometry.pixels(), geometry.cameraMatrix());
}

sensor_msgs::CameraInfo toSourceViewInfo(const std_msgs::Header& header, const fluoroscopy::XRayGeometry& geometry)
{
  return cameraInfo(header, geometry.pixels(), geometry.sourceViewMatrix());
}

geometry_msgs::TransformStamped toTransform(const ros::Time& stamp, const fluoroscopy::XRayGeometry& geometry)
{
  geometry_msgs::TransformStamped message;
  message.header.stamp = stamp;
  message.header.frame_id = names::kPatientFrame;
  message.child_frame_id = names::kXRaySourceFrame;
  const Eigen::Quaterniond rotation(geometry.axes());
  message.transform.translation.x = geometry.source().x();
  message.transform.translation.y = geometry.source().y();
  message.transform.translation.z = geometry.source().z();
  message.transform.rotation.x = rotation.x();
  message.transform.rotation.y = rotation.y();
  message.transform.rotation.z = rotation.z();
  message.transform.rotation.w = rotation.w();
  return message;
}

fluoroscopy::CArmPose poseOf(const geometry_msgs::Transform& source, const fluoroscopy::CArmPose& present)
{
  constexpr double kUnit = 1e-6;  // difference of the quaternion's norm from 1
  const Eigen::Quaterniond rotation(source.rotation.w, source.rotation.x, source.rotation.y, source.rotation.z);
  const Eigen::Vector3d position(source.translation.x, source.translation.y, source.translation.z);
  if (!position.allFinite() || !(std::abs(rotation.norm() - 1.0) < kUnit))
    throw InputError("C-arm", "pose", "must be finite, with a rotation");
  const Eigen::Matrix3d axes = rotation.normalized().toRotationMatrix();
  fluoroscopy::CArmPose pose = present;
  // By the axes of XRayGeometry: right = (cos a, sin a, 0), forward.z = sin b.
  pose.primary_angle = std::atan2(axes(1, 0), axes(0, 0));
  pose.secondary_angle = std::asin(std::clamp(axes(2, 2), -1.0, 1.0));
  pose.isocentre = position + pose.source_to_patient * axes.col(2);
  return pose;
}

geometry_msgs::TransformStamped sourceViewTransform(const ros::Time& stamp)
{
  geometry_msgs::TransformStamped message;
  message.header.stamp = stamp;
  message.header.frame_id = names::kXRaySourceFrame;
  message.child_frame_id = names::kXRaySourceViewFrame;
  message.transform.rotation.z = 1.0;  // half a turn
  return message;
}

fluoroscopy::CArmPose toPose(const CArm& message, const fluoroscopy::CArmPose& present)
{
  const bool by_view = !message.view.empty();
  const auto given = [by_view](double value, double retained) { return by_view && value == 0.0 ? retained : value; };
  fluoroscopy::CArmPose pose = present;
  pose.primary_angle = message.positioner_primary_angle;
  pose.secondary_angle = message.positioner_secondary_angle;
  pose.source_to_detector = given(message.distance_source_to_detector, present.source_to_detector);
  pose.source_to_patient = given(message.distance_source_to_patient, present.source_to_patient);
  pose.detector_width = given(message.detector_width, present.detector_width);
  pose.field_width = given(message.field_width, present.field_width);
  pose.field_height = given(message.field_height, present.field_height);
  const Eigen::Vector3d isocentre = fromMessage(message.isocentre);
  if (!by_view || !isocentre.isZero(0.0))
    pose.isocentre = isocentre;
  if (!by_view)
    return pose;
  const std::optional<fluoroscopy::View> view = fluoroscopy::parseView(message.view);
  if (!view)
    throw InputError("C-arm", "view", fluoroscopy::unknownView(message.view));
  pose.primary_angle = view->primary_angle;
  pose.secondary_angle = view->secondary_angle;
  return pose;
}

CArm toMessage(const fluoroscopy::CArmPose& pose)
{
  CArm message;
  message.positioner_primary_angle = pose.primary_angle;
  message.positioner_secondary_angle = pose.secondary_angle;
  message.distance_source_to_detector = pose.source_to_detector;
  message.distance_source_to_patient = pose.source_to_patient;
  message.isocentre.x = pose.isocentre.x();
  message.isocentre.y = pose.isocentre.y();
  message.isocentre.z = pose.isocentre.z();
  message.detector_width = pose.detector_width;
  message.field_width = pose.field_width;
  message.field_height = pose.field_height;
  return message;
}

simulation::ImagedInstruments imagedInstruments(const RodStateVisual& state, std::size_t instruments)
{
  requireUsable(state, instruments);
  simulation::ImagedInstruments imaged;
  imaged.nodes.reserve(state.nodes.size());
  for (const geometry_msgs::Point& node : state.nodes)
    imaged.nodes.push_back(fromMessage(node));
  const double furthest = *std::max_element(state.insertion.begin(), state.insertion.end());
  for (const double insertion : state.insertion)
    imaged.behind.push_back(furthest - insertion);
  return imaged;
}

}  // namespace endovascular_sim::nodes
