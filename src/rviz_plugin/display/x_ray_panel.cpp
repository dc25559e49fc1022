#include "rviz_plugin/display/x_ray_panel.h"

#include <ros/console.h>
#include <rviz/frame_manager.h>
#include <rviz/visualization_manager.h>
#include <QTimer>
#include <QVBoxLayout>
#include <pluginlib/class_list_macros.hpp>

#include "nodes/runtime/guarded_subscription.h"
#include "nodes/runtime/ros_names.h"
#include "rviz_plugin/display/lesson_window.h"
#include "rviz_plugin/model/message_points.h"
#include "rviz_plugin/widget/font_scale.h"
#include "rviz_plugin/widget/x_ray_view.h"

namespace endovascular_sim::rviz_plugin
{
namespace
{

/** Copy of an image of one byte per pixel; a null image for another or an inconsistent one. */
QImage toImage(const sensor_msgs::Image& message)
{
  const std::size_t size = static_cast<std::size_t>(message.step) * message.height;
  if (message.encoding != "mono8" || message.width == 0 || message.step < message.width || message.data.size() < size)
    return {};
  return QImage(message.data.data(), static_cast<int>(message.width), static_cast<int>(message.height),
                static_cast<int>(message.step), QImage::Format_Grayscale8)
      .copy();
}

Eigen::Vector3d toEigen(const Ogre::Vector3& vector)
{
  return {vector.x, vector.y, vector.z};
}

}  // namespace

XRayPanel::XRayPanel(QWidget* parent) : rviz::Panel(parent), view_(new XRayView)
{
  auto* layout = new QVBoxLayout(this);
  layout->setContentsMargins(0, 0, 0, 0);
  layout->addWidget(view_);
  view_->setFont(scaledFont(view_->font()));
}

void XRayPanel::onInitialize()
{
  try
  {
    namespace names = nodes::names;
    node_.setCallbackQueue(vis_manager_->getUpdateQueue());
    images_ = nodes::subscribeGuarded<sensor_msgs::Image>(
        node_, names::kFluoroscopyImage, 1, [this](const sensor_msgs::ImageConstPtr& image) { receiveImage(*image); });
    cameras_ = nodes::subscribeGuarded<sensor_msgs::CameraInfo>(node_, names::kFluoroscopyCameraInfo, 1,
                                                                [this](const sensor_msgs::CameraInfoConstPtr& camera)
                                                                { receiveCamera(*camera); });
    wires_ = nodes::subscribeGuarded<RodStateVisual>(
        node_, names::kRodStateVisual, 1, [this](const RodStateVisualConstPtr& wire) { receiveWire(*wire); });
  }
  catch (const std::exception& error)  // rviz would end
  {
    ROS_ERROR("X-ray panel: %s", error.what());
  }
}

void XRayPanel::receiveCamera(const sensor_msgs::CameraInfo& message)
{
  frame_ = message.header.frame_id;
  focal_ = message.K[0];
}

void XRayPanel::receiveWire(const RodStateVisual& message)
{
  time_.addState(message.time);
  if (!message.nodes.empty())
    tip_ = toEigen(message.nodes.back());
}

std::optional<XRayPose> XRayPanel::pose() const
{
  Ogre::Vector3 position;
  Ogre::Quaternion orientation;
  if (frame_.empty() || !vis_manager_->getFrameManager()->getTransform(frame_, ros::Time(), position, orientation))
    return std::nullopt;
  return XRayPose{toEigen(position), toEigen(orientation * Ogre::Vector3::UNIT_X),
                  toEigen(orientation * Ogre::Vector3::UNIT_Z)};
}

void XRayPanel::receiveImage(const sensor_msgs::Image& message)
{
  const QImage image = toImage(message);
  if (image.isNull())
    return;
  time_.addImage(message.header.stamp.toSec());
  view_->showMarks(xRayMarks(pose(), focal_, image.width(), tip_, time_.seconds()));
  view_->showImage(image);
}

void XRayPanel::load(const rviz::Config& config)
{
  rviz::Panel::load(config);
  if (config.mapGetBool("Lesson Layout", &is_lesson_) && is_lesson_)
    QTimer::singleShot(0, this, [this] { arrangeForLesson(*window()); });  // after the window has its geometry
}

void XRayPanel::save(rviz::Config config) const
{
  rviz::Panel::save(config);
  config.mapSetValue("Lesson Layout", is_lesson_);
}

}  // namespace endovascular_sim::rviz_plugin

PLUGINLIB_EXPORT_CLASS(endovascular_sim::rviz_plugin::XRayPanel, rviz::Panel)
