#include "rviz_plugin/widget/pressure_trace_view.h"

#include <algorithm>
#include <cmath>

#include <QPainter>
#include <QPainterPath>

#include "common/units.h"
#include "rviz_plugin/widget/font_scale.h"

namespace endovascular_sim::rviz_plugin
{
namespace
{

using units::kMillimetreOfMercury;

constexpr double kCardiogram = 0.22;  // share of the height that the electrocardiogram takes
constexpr double kStep = 40.0;        // of the scale [mmHg]
constexpr int kLines = 6;             // height in lines of text

const QColor kBackground("#0d1117"), kGridColour("#2c3540"), kTextColour("#9fb0c0"), kHeart("#4fd06a");

}  // namespace

PressureTraceView::PressureTraceView()
{
  setObjectName("pressure_trace");
  setFont(scaledFont(font()));
  setFixedHeight(kLines * fontMetrics().lineSpacing());
}

QSize PressureTraceView::sizeHint() const
{
  return {200, height()};
}

QColor PressureTraceView::colourOf(std::size_t line, std::size_t lines)
{
  return line + 1 == lines ? QColor("#ff6b61") : QColor("#ffd24a");
}

void PressureTraceView::showBlood(const BloodState& blood)
{
  blood_ = blood;
  double highest = 0.0;
  for (const PressureTrace& line : blood_.lines)
    for (const auto& [time, pressure] : line.readings)
      highest = std::max(highest, pressure / kMillimetreOfMercury);
  // The scale grows at once and shrinks where a full step remains free.
  const double wanted = std::max(4.0 * kStep, std::ceil(highest / kStep) * kStep);
  if (wanted > top_ || wanted < top_ - kStep)
    top_ = wanted;
  update();
}

double PressureTraceView::ordinateOf(double pressure) const
{
  const double share = pressure / kMillimetreOfMercury / top_;
  return height() - 2.0 - share * (1.0 - kCardiogram) * (height() - 4.0);
}

double PressureTraceView::abscissaOf(double time) const
{
  return width() * (1.0 - (blood_.time - time) / PressureMonitor::kDuration);
}

void PressureTraceView::drawGrid(QPainter& painter) const
{
  for (double level = 0.0; level <= top_; level += kStep)
  {
    const double y = ordinateOf(level * kMillimetreOfMercury);
    painter.setPen(kGridColour);
    painter.drawLine(QPointF(0.0, y), QPointF(width(), y));
    if (level <= 0.0)
      continue;
    painter.setPen(kTextColour);
    painter.drawText(QPointF(2.0, y - 1.0), QString::number(level) + (level + kStep > top_ ? " mmHg" : ""));
  }
}

void PressureTraceView::paintEvent(QPaintEvent* /*event*/)
{
  QPainter painter(this);
  painter.fillRect(rect(), kBackground);
  drawGrid(painter);
  painter.setRenderHint(QPainter::Antialiasing);
  const auto draw = [&](const auto& points, const QColor& colour, const auto& ordinate)
  {
    QPainterPath path;
    for (std::size_t k = 0; k < points.size(); ++k)
    {
      const QPointF point(abscissaOf(points[k].first), ordinate(points[k].second));
      k == 0 ? path.moveTo(point) : path.lineTo(point);
    }
    painter.setPen(QPen(colour, 1.6));
    painter.drawPath(path);
  };
  const double band = kCardiogram * height();
  draw(blood_.phases, kHeart, [band](double phase) { return 0.75 * band - 0.6 * band * electrocardiogram(phase); });
  for (std::size_t k = 0; k < blood_.lines.size(); ++k)
    draw(blood_.lines[k].readings, colourOf(k, blood_.lines.size()),
         [this](double pressure) { return ordinateOf(pressure); });
}

}  // namespace endovascular_sim::rviz_plugin
