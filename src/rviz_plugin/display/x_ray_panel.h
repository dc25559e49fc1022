#pragma once

#include <ros/node_handle.h>
#include <ros/subscriber.h>
#include <rviz/panel.h>
#include <sensor_msgs/CameraInfo.h>
#include <sensor_msgs/Image.h>

#include "endovascular_sim/RodStateVisual.h"
#include "rviz_plugin/picture/x_ray_marks.h"

namespace endovascular_sim::rviz_plugin
{

class XRayView;

/** Panel of rviz with the X-ray image and its marks. With "Lesson Layout" in its configuration it arranges the window
 *  for a lesson. */
class XRayPanel : public rviz::Panel
{
  Q_OBJECT

public:
  explicit XRayPanel(QWidget* parent = nullptr);

  void onInitialize() override;
  void load(const rviz::Config& config) override;
  void save(rviz::Config config) const override;

private:
  void receiveImage(const sensor_msgs::Image& message);
  void receiveCamera(const sensor_msgs::CameraInfo& message);
  void receiveWire(const RodStateVisual& message);
  std::optional<XRayPose> pose() const;

  XRayView* view_;  ///< owned by Qt
  bool is_lesson_ = false;
  ros::NodeHandle node_;
  ros::Subscriber images_, cameras_, wires_;
  FluoroscopyTime time_;
  std::string frame_;                              ///< of the source
  double focal_ = 0.0;                             ///< [image pixels]
  Eigen::Vector3d tip_ = Eigen::Vector3d::Zero();  ///< [m]
};

}  // namespace endovascular_sim::rviz_plugin
