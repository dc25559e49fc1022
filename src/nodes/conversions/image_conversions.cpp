#include "nodes/conversions/image_conversions.h"

#include <algorithm>
#include <cstring>
#include <string>

#include <sensor_msgs/image_encodings.h>

#include "common/error.h"
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

}  // namespace

Eigen::Vector3d toEigen(const geometry_msgs::Point& point)
{
  return {point.x, point.y, point.z};
}

sensor_msgs::Image toImage(const std_msgs::Header& header, int pixels, const std::vector<std::uint8_t>& grey)
{
  return image(header, pixels, grey, sensor_msgs::image_encodings::MONO8);
}

sensor_msgs::Image toImage(const std_msgs::Header& header, int pixels, const std::vector<std::uint16_t>& signal)
{
  return image(header, pixels, signal, sensor_msgs::image_encodings::MONO16);
}

sensor_msgs::CameraInfo toCameraInfo(const std_msgs::Header& header, const fluoroscopy::XRayGeometry& geometry)
{
  sensor_msgs::CameraInfo info;
  info.header = header;
  info.width = info.height = static_cast<std::uint32_t>(geometry.pixels());
  info.distortion_model = "plumb_bob";
  info.D.assign(5, 0.0);
  const Eigen::Matrix3d k = geometry.cameraMatrix();
  std::size_t i = 0, j = 0;  // row-major indices into K and R, and into P
  for (int row = 0; row < 3; ++row, ++j)
    for (int column = 0; column < 3; ++column, ++i, ++j)
    {
      info.K[i] = info.P[j] = k(row, column);
      info.R[i] = row == column ? 1.0 : 0.0;
    }
  return info;
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

fluoroscopy::CArmPose toPose(const CArm& message, int pixels)
{
  fluoroscopy::CArmPose pose;
  pose.primary_angle = message.positioner_primary_angle;
  pose.secondary_angle = message.positioner_secondary_angle;
  pose.source_to_detector = message.distance_source_to_detector;
  pose.source_to_patient = message.distance_source_to_patient;
  pose.isocentre = toEigen(message.isocentre);
  pose.detector_width = message.detector_width;
  pose.pixels = pixels;
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
  return message;
}

geometry::TriangleMesh toMesh(const VesselMesh& message)
{
  geometry::TriangleMesh mesh;
  mesh.vertices.reserve(message.mesh.vertices.size());
  for (const geometry_msgs::Point& vertex : message.mesh.vertices)
  {
    mesh.vertices.push_back(toEigen(vertex));
    if (!mesh.vertices.back().allFinite())
      throw InputError(names::kVesselMesh, "vertex " + std::to_string(mesh.vertices.size() - 1), "must be finite");
  }
  mesh.triangles.reserve(message.mesh.triangles.size());
  for (const shape_msgs::MeshTriangle& triangle : message.mesh.triangles)
  {
    for (const std::uint32_t index : triangle.vertex_indices)
      if (index >= mesh.vertices.size())
        throw InputError(names::kVesselMesh, "triangle " + std::to_string(mesh.triangles.size()),
                         "vertex " + std::to_string(index) + " does not exist: the mesh has " +
                             std::to_string(mesh.vertices.size()));
    mesh.triangles.emplace_back(static_cast<int>(triangle.vertex_indices[0]),
                                static_cast<int>(triangle.vertex_indices[1]),
                                static_cast<int>(triangle.vertex_indices[2]));
  }
  return mesh;
}

std::vector<fluoroscopy::XRayWire> toXRayWires(const RodStateVisual& state,
                                               const std::vector<fluoroscopy::XRayInstrument>& instruments,
                                               const fluoroscopy::LocalFluids& fluids)
{
  if (state.insertion.size() != instruments.size())
    throw InputError(names::kRodStateVisual, "insertion", "must have one value for each instrument of the scene");
  std::vector<Eigen::Vector3d> nodes;
  nodes.reserve(state.nodes.size());
  for (const geometry_msgs::Point& node : state.nodes)
    nodes.push_back(toEigen(node));
  const double furthest = *std::max_element(state.insertion.begin(), state.insertion.end());
  std::vector<double> behind;
  for (const double insertion : state.insertion)
    behind.push_back(furthest - insertion);
  return {fluoroscopy::coaxialStack(nodes, instruments, behind, {fluids})};
}

}  // namespace endovascular_sim::nodes
