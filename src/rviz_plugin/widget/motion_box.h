#pragma once

#include <QString>
#include <QWidget>

#include "rviz_plugin/model/motion_monitor.h"

class QLabel;
class QPushButton;
class QSpinBox;

namespace endovascular_sim::rviz_plugin
{

class SessionPort;

/** Rows of the panel for heart and breath: phases, rates and breath-hold. */
class MotionBox : public QWidget
{
public:
  /** @param keys takes the focus after an input */
  MotionBox(SessionPort& port, QWidget& keys);

  /** @param has_flow true: the flow of blood sets the heart rate
   *  @param is_played true: a recording is played, which nobody changes */
  void showMotion(const MotionStatus& motion, bool has_flow, bool is_played);

private:
  QLabel* phases_;
  QSpinBox *heart_, *breath_;
  QPushButton* hold_;
};

/** Text of the phases, e.g. "Heart and breath: systole, breathing". */
QString phaseText(const MotionStatus& motion);

}  // namespace endovascular_sim::rviz_plugin
