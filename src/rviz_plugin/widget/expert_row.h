#pragma once

#include <QWidget>

#include "endovascular_sim/ExpertState.h"
#include "rviz_plugin/model/session_port.h"

class QComboBox;
class QLabel;

namespace endovascular_sim::rviz_plugin
{

/** Row of the panel that shows the expert beside the trainee, in an alignment, and the distance of the tips. */
class ExpertRow : public QWidget
{
public:
  /** @param port, keys as of SessionRow */
  ExpertRow(SessionPort& port, QWidget& keys);

  void showState(const ExpertState& state);

private:
  QComboBox* alignments_;
  QLabel* distance_;
};

}  // namespace endovascular_sim::rviz_plugin
