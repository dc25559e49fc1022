#pragma once

#include <ros/node_handle.h>
#include <ros/subscriber.h>
#include <rviz/view_controller.h>

#include "rviz_plugin/model/motion_follower.h"
#include "rviz_plugin/picture/camera_guide.h"

namespace endovascular_sim::rviz_plugin
{

/** View of rviz whose camera moves with the session. Left button: turns; right button and wheel: distance. */
class SessionView : public rviz::ViewController
{
  Q_OBJECT

public:
  explicit SessionView(ViewMode mode);
  ~SessionView() override;

  void update(float dt, float ros_dt) override;
  void handleMouseEvent(rviz::ViewportMouseEvent& event) override;
  void lookAt(const Ogre::Vector3& /*point*/) override {}
  void mimic(rviz::ViewController* source_view) override;
  void reset() override;

protected:
  void onInitialize() override;

private:
  void move(double seconds);
  double aspect() const;
  ViewSetting setting() const;

  CameraGuide guide_;
  rviz::FloatProperty *yaw_, *pitch_, *distance_;
  MotionFollower follower_;
  ros::NodeHandle node_;
  ros::Subscriber centreline_subscriber_, wire_subscriber_, motion_subscriber_;
  std::string frame_;  ///< of the messages; empty: that of the camera
};

/** The whole vessel. */
class Overview : public SessionView
{
  Q_OBJECT

public:
  Overview() : SessionView(ViewMode::kOverview) {}
};

/** The tip in the middle. */
class TipView : public SessionView
{
  Q_OBJECT

public:
  TipView() : SessionView(ViewMode::kFollowTip) {}
};

/** From inside the vessel towards the tip. */
class VesselView : public SessionView
{
  Q_OBJECT

public:
  VesselView() : SessionView(ViewMode::kAlongVessel) {}
};

}  // namespace endovascular_sim::rviz_plugin
