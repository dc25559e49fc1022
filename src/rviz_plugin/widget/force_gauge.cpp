#include "rviz_plugin/widget/force_gauge.h"

#include <QPainter>

#include "rviz_plugin/widget/font_scale.h"

namespace endovascular_sim::rviz_plugin
{
namespace
{

constexpr int kMarkWidth = 3;  // [pixels]

QString colourOf(int share)
{
  return share < 50 ? "#3c9d4e" : share < 80 ? "#d9a018" : "#c62f2f";
}

}  // namespace

ForceGauge::ForceGauge()
{
  setObjectName("gauge");
  setRange(0, 100);
  setFont(scaledFont(font()));
}

void ForceGauge::showForce(int share, int peak)
{
  peak_ = peak;
  setFormat(QString("%1 % of the force limit, peak %2 %").arg(share).arg(peak));
  setStyleSheet(
      QString("QProgressBar { text-align: center } QProgressBar::chunk { background: %1 }").arg(colourOf(share)));
  setValue(share);  // last: it draws at once
  update();
}

void ForceGauge::paintEvent(QPaintEvent* event)
{
  QProgressBar::paintEvent(event);
  if (peak_ <= 0)
    return;
  QPainter painter(this);
  const int left = (width() - kMarkWidth) * peak_ / 100;
  // Above and below the text, which it would strike through.
  const int length = height() / 4;
  for (const int top : {0, height() - length})
    painter.fillRect(left, top, kMarkWidth, length, QColor(colourOf(peak_)).darker(140));
}

}  // namespace endovascular_sim::rviz_plugin
