#pragma once

#include <memory>

#include <rviz/panel.h>

#include "rviz_plugin/model/session_port.h"

namespace endovascular_sim::rviz_plugin
{

class SessionWidget;

/** Panel of rviz with the controls of a session. */
class SessionPanel : public rviz::Panel
{
  Q_OBJECT

public:
  explicit SessionPanel(QWidget* parent = nullptr);
  ~SessionPanel() override;

  void onInitialize() override;
  void load(const rviz::Config& config) override;
  void save(rviz::Config config) const override;

private Q_SLOTS:
  void showView(const QString& view);

private:  // NOLINT(readability-redundant-access-specifiers): after slots
  std::unique_ptr<SessionPort> session_;
  SessionWidget* widget_ = nullptr;  ///< owned by Qt; null before the initialisation, or if it failed
  int speed_setting_ = 60;
};

}  // namespace endovascular_sim::rviz_plugin
