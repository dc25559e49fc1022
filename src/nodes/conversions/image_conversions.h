#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include <geometry_msgs/TransformStamped.h>
#include <sensor_msgs/CameraInfo.h>
#include <sensor_msgs/Image.h>

#include "endovascular_sim/CArm.h"
#include "endovascular_sim/RodStateVisual.h"
#include "fluoroscopy/beam/material_library.h"
#include "fluoroscopy/fluoroscope.h"
#include "scene/model/scene.h"
#include "simulation/imaged_bodies.h"

namespace endovascular_sim::nodes
{

/** A square mono8 image. */
sensor_msgs::Image toImage(const std_msgs::Header& header, int pixels, const std::vector<std::uint8_t>& grey);

/** A square mono16 image. */
sensor_msgs::Image toImage(const std_msgs::Header& header, int pixels, const std::vector<std::uint16_t>& signal);

/** Camera of the optical frame `x_ray_source_optical` (x image right, y image up, z from the source to the detector):
 *  K = [f 0 c; 0 −f c; 0 0 1], f = SID / pixel size, P = [K 0], D = 0, R = 1. f_y is negative because a radiograph is
 *  seen from the detector, the mirror image of a camera's view from the source (see XRayGeometry). */
sensor_msgs::CameraInfo toCameraInfo(const std_msgs::Header& header, const fluoroscopy::XRayGeometry& geometry);

/** Camera of the source view (see XRayGeometry), in the frame `x_ray_source_view_optical`: f_x = f_y > 0. */
sensor_msgs::CameraInfo toSourceViewInfo(const std_msgs::Header& header, const fluoroscopy::XRayGeometry& geometry);

/** The image with its columns in reverse order. */
sensor_msgs::Image mirrored(const sensor_msgs::Image& image);

/** From `x_ray_source_optical` to `patient`. */
geometry_msgs::TransformStamped toTransform(const ros::Time& stamp, const fluoroscopy::XRayGeometry& geometry);
/** Pose of the C-arm whose source is at a transform of the function above.
 *  @param present gives what the transform does not hold: distances, width and field of the detector
 *  @throws InputError for a transform that is not finite or no rotation */
fluoroscopy::CArmPose poseOf(const geometry_msgs::Transform& source, const fluoroscopy::CArmPose& present);

/** From `x_ray_source_view_optical` to `x_ray_source_optical`, for all poses. */
geometry_msgs::TransformStamped sourceViewTransform(const ros::Time& stamp);

/** C-arm pose of a command.
 *  @param present present target, for quantities that the command retains, and for the size of the image
 *  @throws InputError for an unknown view */
fluoroscopy::CArmPose toPose(const CArm& message, const fluoroscopy::CArmPose& present);

/** Command that moves the C-arm to a pose, without a header. */
CArm toMessage(const fluoroscopy::CArmPose& pose);

/** Instruments of an image. The nodes of the message end at the tip of the instrument that reaches farthest.
 *  @param instruments their number
 *  @throws InputError when lists have wrong lengths, or a number is not finite */
simulation::ImagedInstruments imagedInstruments(const RodStateVisual& state, std::size_t instruments);

}  // namespace endovascular_sim::nodes
