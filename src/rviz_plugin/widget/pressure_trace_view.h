#pragma once

#include <QWidget>

#include "rviz_plugin/model/pressure_monitor.h"

namespace endovascular_sim::rviz_plugin
{

/** Traces of blood pressure in mmHg below an electrocardiogram, as a monitor of a catheter laboratory shows them. */
class PressureTraceView : public QWidget
{
public:
  PressureTraceView();

  void showBlood(const BloodState& blood);
  QSize sizeHint() const override;

  /** Colour of a trace. @param line from the innermost instrument out; @param lines number of them */
  static QColor colourOf(std::size_t line, std::size_t lines);

protected:
  void paintEvent(QPaintEvent* event) override;

private:
  void drawGrid(QPainter& painter) const;
  double ordinateOf(double pressure) const;
  double abscissaOf(double time) const;

  BloodState blood_;
  double top_ = 160.0;  ///< of the scale [mmHg]
};

}  // namespace endovascular_sim::rviz_plugin
