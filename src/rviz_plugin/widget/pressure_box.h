#pragma once

#include <QWidget>

#include "rviz_plugin/model/session_state.h"

class QLabel;
class QPushButton;
class QSpinBox;

namespace endovascular_sim::rviz_plugin
{

class PressureTraceView;
class SessionPort;

/** Box of the panel for the blood: traces of pressure, their values, and the inputs of the circulation. */
class PressureBox : public QWidget
{
public:
  /** @param keys takes the focus after an input */
  PressureBox(SessionPort& port, QWidget& keys);

  /** @param is_played true: a recording is played, which nobody changes */
  void showBlood(const BloodState& blood, bool is_played);

private:
  PressureTraceView* trace_;
  QLabel *values_, *ratio_;
  QPushButton* adenosine_;
  QSpinBox *rate_, *pressure_;
};

/** Texts of the box. @{ */
QString pressureText(const BloodState& blood);  ///< e.g. "catheter 115/73 (87)", a line per pressure line
QString ratioText(const BloodState& blood);     ///< e.g. "FFR 0.78"; empty without a ratio
/** @} */

}  // namespace endovascular_sim::rviz_plugin
