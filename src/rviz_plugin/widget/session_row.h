#pragma once

#include <QWidget>

#include "rviz_plugin/model/session_port.h"

class QLabel;
class QPushButton;

namespace endovascular_sim::rviz_plugin
{

/** Row of the panel that starts, pauses, resets and records a session, with its state. */
class SessionRow : public QWidget
{
public:
  /** @param port outlives the row
   *  @param keys widget that has the keys after a click; outlives the row */
  SessionRow(SessionPort& port, QWidget& keys);

  void showState(const SessionState& state, const PanelTexts& texts);

private:
  bool is_recording_ = false;
  QPushButton *record_, *repeat_;
  QLabel *status_, *recording_;
};

}  // namespace endovascular_sim::rviz_plugin
