#pragma once

#include <cstdint>
#include <vector>

#include <geometry_msgs/TransformStamped.h>
#include <sensor_msgs/CameraInfo.h>
#include <sensor_msgs/Image.h>

#include "endovascular_sim/CArm.h"
#include "endovascular_sim/RodStateVisual.h"
#include "endovascular_sim/VesselMesh.h"
#include "fluoroscopy/attenuation.h"
#include "fluoroscopy/fluoroscope.h"
#include "fluoroscopy/x_ray_instrument.h"
#include "scene/model/scene.h"

namespace endovascular_sim::nodes
{

Eigen::Vector3d toEigen(const geometry_msgs::Point& point);

/** A square mono8 image. */
sensor_msgs::Image toImage(const std_msgs::Header& header, int pixels, const std::vector<std::uint8_t>& grey);

/** A square mono16 image. */
sensor_msgs::Image toImage(const std_msgs::Header& header, int pixels, const std::vector<std::uint16_t>& signal);

/** Camera of the optical frame `x_ray_source_optical` (x image right, y image up, z from the source to the detector):
 *  K = [f 0 c; 0 −f c; 0 0 1], f = SID / pixel size, P = [K 0], D = 0, R = 1. f_y is negative because a radiograph is
 *  seen from the detector, the mirror image of a camera's view from the source (see XRayGeometry). */
sensor_msgs::CameraInfo toCameraInfo(const std_msgs::Header& header, const fluoroscopy::XRayGeometry& geometry);

/** From `x_ray_source_optical` to `patient`. */
geometry_msgs::TransformStamped toTransform(const ros::Time& stamp, const fluoroscopy::XRayGeometry& geometry);

/** C-arm pose of a command, with the image's size that no command changes. */
fluoroscopy::CArmPose toPose(const CArm& message, int pixels);

/** The command that a pose answers; header left empty. */
CArm toMessage(const fluoroscopy::CArmPose& pose);

/** Triangles of a vessel message [m].
 *  @throws InputError when an index has no vertex or a coordinate is not finite */
geometry::TriangleMesh toMesh(const VesselMesh& message);

/** What X-rays see of all instruments. The message ends at the tip of the one that reaches furthest.
 *  @throws InputError when there is not one insertion per instrument */
std::vector<fluoroscopy::XRayWire> toXRayWires(const RodStateVisual& state,
                                               const std::vector<fluoroscopy::XRayInstrument>& instruments);

}  // namespace endovascular_sim::nodes
