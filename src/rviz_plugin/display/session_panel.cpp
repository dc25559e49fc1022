#include "rviz_plugin/display/session_panel.h"

#include <ros/console.h>
#include <rviz/render_panel.h>
#include <rviz/view_manager.h>
#include <rviz/visualization_manager.h>
#include <QLabel>
#include <QVBoxLayout>
#include <pluginlib/class_list_macros.hpp>

#include "rviz_plugin/model/session_client.h"
#include "rviz_plugin/widget/session_widget.h"

namespace endovascular_sim::rviz_plugin
{

SessionPanel::SessionPanel(QWidget* parent) : rviz::Panel(parent)
{
  auto* layout = new QVBoxLayout(this);
  layout->setContentsMargins(0, 0, 0, 0);
}

SessionPanel::~SessionPanel()
{
  delete widget_;  // before the session that it uses
}

void SessionPanel::onInitialize()
{
  try
  {
    session_ = std::make_unique<SessionClient>(ros::NodeHandle());
    widget_ = new SessionWidget(*session_, this);
    widget_->setSpeedSetting(speed_setting_);
    layout()->addWidget(widget_);
    widget_->takeKeysOf(*vis_manager_->getRenderPanel());  // a click into the picture must not end the keys
    connect(widget_, &SessionWidget::viewChosen, this, &SessionPanel::showView);
  }
  catch (const std::exception& error)  // rviz would end
  {
    layout()->addWidget(new QLabel(QString::fromUtf8(error.what())));
  }
}

void SessionPanel::showView(const QString& view)
{
  try
  {
    rviz::ViewManager* views = vis_manager_->getViewManager();
    if (views != nullptr)
      views->setCurrentViewControllerType("endovascular_sim/" + view);
  }
  catch (const std::exception& error)  // rviz would end
  {
    ROS_ERROR("view %s: %s", view.toUtf8().constData(), error.what());
  }
}

void SessionPanel::load(const rviz::Config& config)
{
  rviz::Panel::load(config);
  if (config.mapGetInt("Speed", &speed_setting_) && widget_ != nullptr)
    widget_->setSpeedSetting(speed_setting_);
}

void SessionPanel::save(rviz::Config config) const
{
  rviz::Panel::save(config);
  config.mapSetValue("Speed", widget_ != nullptr ? widget_->speedSetting() : speed_setting_);
}

}  // namespace endovascular_sim::rviz_plugin

PLUGINLIB_EXPORT_CLASS(endovascular_sim::rviz_plugin::SessionPanel, rviz::Panel)
