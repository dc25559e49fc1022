#pragma once

#include <QWidget>

#include "rviz_plugin/model/session_state.h"

class QLabel;

namespace endovascular_sim::rviz_plugin
{

class ForceGauge;

/** Box of the panel with the state of the chosen instrument and of the session: forces, procedure, errors. */
class StateBox : public QWidget
{
public:
  StateBox();

  void showState(const SessionState& state, const PanelTexts& texts);

private:
  ForceGauge* gauge_;
  QLabel *force_, *insertion_, *rotation_, *torque_, *branch_, *time_, *step_, *hint_, *answer_, *errors_, *warnings_;
};

}  // namespace endovascular_sim::rviz_plugin
