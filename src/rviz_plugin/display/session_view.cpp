#include "rviz_plugin/display/session_view.h"

#include <algorithm>
#include <cmath>

#include <OgreCamera.h>
#include <OgreViewport.h>
#include <rviz/display_context.h>
#include <rviz/frame_manager.h>
#include <rviz/properties/float_property.h>
#include <rviz/viewport_mouse_event.h>
#include <pluginlib/class_list_macros.hpp>

#include "nodes/runtime/guarded_subscription.h"
#include "nodes/runtime/ros_names.h"
#include "rviz_plugin/display/motion_subscription.h"
#include "rviz_plugin/widget/legend_picture.h"

namespace endovascular_sim::rviz_plugin
{
namespace
{

constexpr float kTurnPerPixel = 0.008F;    // [rad]
constexpr float kZoomPerPixel = 0.005F;    // [1]
constexpr float kZoomPerWheelStep = 0.1F;  // [1]
constexpr float kNearClip = 1e-3F;         // [m]

Ogre::Vector3 toOgre(const Eigen::Vector3d& vector)
{
  return {static_cast<float>(vector.x()), static_cast<float>(vector.y()), static_cast<float>(vector.z())};
}

Eigen::Vector3d toEigen(const Ogre::Vector3& vector)
{
  return {vector.x, vector.y, vector.z};
}

// rviz reads the pose of the camera itself, not that of a node that would carry it; Ogre calls this deprecated.
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wdeprecated-declarations"
/** @return false if the camera is there already */
bool moveCamera(Ogre::Camera& camera, const Ogre::Vector3& position, const Ogre::Quaternion& orientation)
{
  if (position.positionEquals(camera.getPosition(), 1e-6F) &&
      orientation.equals(camera.getOrientation(), Ogre::Radian(1e-5F)))
    return false;
  camera.setPosition(position);
  camera.setOrientation(orientation);
  return true;
}
#pragma GCC diagnostic pop

}  // namespace

SessionView::SessionView(ViewMode mode) : guide_(mode)
{
  const ViewSetting begin;
  yaw_ = new rviz::FloatProperty("Yaw", static_cast<float>(begin.yaw),
                                 "Direction of the camera about the patient's axis, in rad. 0: from the front.", this);
  pitch_ = new rviz::FloatProperty("Pitch", static_cast<float>(begin.pitch), "Height of the camera, in rad.", this);
  pitch_->setMin(-1.48F);
  pitch_->setMax(1.48F);
  distance_ = new rviz::FloatProperty("Distance", 0.0F, "Distance of the camera, in m. 0: that of the view.", this);
  distance_->setMin(0.0F);
}

SessionView::~SessionView() = default;

void SessionView::onInitialize()
{
  try
  {
    node_.setCallbackQueue(context_->getUpdateQueue());
    centreline_subscriber_ = nodes::subscribeGuarded<VesselCentreline>(node_, nodes::names::kVesselCentreline, 1,
                                                                       [this](const VesselCentrelineConstPtr& message)
                                                                       {
                                                                         frame_ = message->header.frame_id;
                                                                         guide_.setVessel(*message);
                                                                       });
    wire_subscriber_ = nodes::subscribeGuarded<RodStateVisual>(node_, nodes::names::kRodStateVisual, 1,
                                                               [this](const RodStateVisualConstPtr& message)
                                                               {
                                                                 frame_ = message->header.frame_id;
                                                                 follower_.add(message);
                                                               });
    motion_subscriber_ = subscribeToMotion(node_, nodes::names::kMotionState, follower_);
    near_clip_property_->setFloat(kNearClip);
  }
  catch (const std::exception& error)  // rviz would end
  {
    setStatus(QString::fromUtf8(error.what()));
  }
}

ViewSetting SessionView::setting() const
{
  const Ogre::Viewport* viewport = camera_->getViewport();
  const int height = viewport != nullptr ? viewport->getActualHeight() : 0;
  const int legends = legendsSize().height();
  return {yaw_->getFloat(), pitch_->getFloat(), distance_->getFloat(),
          height > 2 * legends ? static_cast<double>(legends) / height : 0.0};
}

double SessionView::aspect() const
{
  const Ogre::Viewport* viewport = camera_->getViewport();
  if (viewport != nullptr && viewport->getActualHeight() > 0)
    return static_cast<double>(viewport->getActualWidth()) / viewport->getActualHeight();
  return camera_->getAspectRatio();
}

void SessionView::update(float dt, float /*ros_dt*/)
{
  try
  {
    move(dt);
  }
  catch (const std::exception& error)
  {
    setStatus(QString::fromUtf8(error.what()));
  }
}

void SessionView::move(double seconds)
{
  if (follower_.advance(seconds) && follower_.wire())
    guide_.setWire(*follower_.wire(), follower_.map());
  Ogre::Vector3 position = Ogre::Vector3::ZERO;
  Ogre::Quaternion orientation = Ogre::Quaternion::IDENTITY;
  if (!frame_.empty() && !context_->getFrameManager()->getTransform(frame_, ros::Time(), position, orientation))
    return;
  const CameraPose pose = guide_.advance(setting(), seconds, aspect(), camera_->getFOVy().valueRadians());
  const Ogre::Vector3 eye = position + orientation * toOgre(pose.eye);
  // Axes of an Ogre camera: x right, y up, against z the direction of view.
  const Ogre::Vector3 backward = (orientation * toOgre(pose.eye - pose.focus)).normalisedCopy();
  const Ogre::Vector3 up = orientation * toOgre(pose.up);
  const Ogre::Quaternion axes(up.crossProduct(backward), up, backward);
  if (moveCamera(*camera_, eye, axes))
    context_->queueRender();
}

void SessionView::handleMouseEvent(rviz::ViewportMouseEvent& event)
{
  if (event.type == QEvent::MouseMove && event.left())
  {
    yaw_->add(-kTurnPerPixel * static_cast<float>(event.x - event.last_x));
    pitch_->add(kTurnPerPixel * static_cast<float>(event.y - event.last_y));
  }
  float zoom = 0.0F;
  if (event.type == QEvent::MouseMove && event.right())
    zoom = kZoomPerPixel * static_cast<float>(event.y - event.last_y);
  if (event.wheel_delta != 0)
    zoom = event.wheel_delta > 0 ? -kZoomPerWheelStep : kZoomPerWheelStep;
  if (zoom == 0.0F)
    return;
  const float present =
      distance_->getFloat() > 0.0F
          ? distance_->getFloat()
          : static_cast<float>(guide_.distance(setting(), aspect(), camera_->getFOVy().valueRadians()));
  distance_->setFloat(present * std::exp(zoom));
}

void SessionView::mimic(rviz::ViewController* source_view)
{
  const Ogre::Camera* camera = source_view->getCamera();
  const Eigen::Vector3d eye = toEigen(camera->getDerivedPosition());
  const Eigen::Vector3d forward = toEigen(camera->getDerivedDirection());
  guide_.beginAt({eye, eye + 0.2 * forward, toEigen(camera->getDerivedUp())});
}

void SessionView::reset()
{
  const ViewSetting begin;
  yaw_->setFloat(static_cast<float>(begin.yaw));
  pitch_->setFloat(static_cast<float>(begin.pitch));
  distance_->setFloat(0.0F);
}

}  // namespace endovascular_sim::rviz_plugin

PLUGINLIB_EXPORT_CLASS(endovascular_sim::rviz_plugin::Overview, rviz::ViewController)
PLUGINLIB_EXPORT_CLASS(endovascular_sim::rviz_plugin::TipView, rviz::ViewController)
PLUGINLIB_EXPORT_CLASS(endovascular_sim::rviz_plugin::VesselView, rviz::ViewController)
