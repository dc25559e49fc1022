#include "rviz_plugin/widget/pressure_box.h"

#include <cmath>

#include <QHBoxLayout>
#include <QLabel>
#include <QPushButton>
#include <QSpinBox>
#include <QVBoxLayout>

#include "common/units.h"
#include "rviz_plugin/model/session_port.h"
#include "rviz_plugin/widget/panel_parts.h"
#include "rviz_plugin/widget/pressure_trace_view.h"

namespace endovascular_sim::rviz_plugin
{
namespace
{

using units::kMillimetreOfMercury;

constexpr double kMinute = 60.0;                                            // [s]
constexpr int kSlowest = 20, kFastest = 300, kLowest = 15, kHighest = 300;  // beats per minute, mmHg

QString rounded(double pressure)
{
  return std::isfinite(pressure) ? QString::number(std::lround(pressure / kMillimetreOfMercury)) : QString("–");
}

}  // namespace

QString pressureText(const BloodState& blood)
{
  QStringList texts;
  for (std::size_t k = 0; k < blood.lines.size(); ++k)
  {
    const PressureTrace& line = blood.lines[k];
    texts << QString("<span style=\"color: %1\">■</span> %2 <b>%3/%4 (%5)</b>")
                 .arg(PressureTraceView::colourOf(k, blood.lines.size()).darker(120).name(),
                      QString::fromStdString(line.name).toHtmlEscaped(), rounded(line.highest), rounded(line.lowest),
                      rounded(line.mean));
  }
  return texts.join("<br>");
}

QString ratioText(const BloodState& blood)
{
  if (!blood.ratio)
    return "";
  return QString("%1 %2").arg(blood.is_reserve ? "FFR" : "Pd/Pa").arg(*blood.ratio, 0, 'f', 2);
}

PressureBox::PressureBox(SessionPort& port, QWidget& keys)
{
  auto* layout = compact(new QVBoxLayout(this));
  trace_ = new PressureTraceView;
  layout->addWidget(trace_);
  auto* numbers = compact(new QHBoxLayout);
  values_ = panelLabel("pressures");
  values_->setTextFormat(Qt::RichText);
  ratio_ = panelLabel("pressure_ratio");
  ratio_->setStyleSheet("font-weight: bold");
  ratio_->setAlignment(Qt::AlignRight | Qt::AlignVCenter);
  numbers->addWidget(values_, 2);
  numbers->addWidget(ratio_, 1);
  layout->addLayout(numbers);
  auto* inputs = compact(new QHBoxLayout);
  adenosine_ = panelButton(
      "Adenosine", "adenosine",
      [this, &port] {
        port.setBlood({BloodRequest::unchanged(), BloodRequest::unchanged(), adenosine_->isChecked() ? 1 : 0});
      });
  adenosine_->setCheckable(true);
  adenosine_->setToolTip("dilates the small vessels of the heart's muscle");
  rate_ = numberBox("heart_rate", " /min", kSlowest, kFastest);
  rate_->setToolTip("heart rate; type a number, then Enter");
  pressure_ = numberBox("mean_pressure", " mmHg", kLowest, kHighest);
  pressure_->setToolTip("mean pressure that the circulation aims at; type a number, then Enter");
  inputs->addWidget(adenosine_);
  inputs->addWidget(rate_, 1);
  inputs->addWidget(pressure_, 1);
  layout->addLayout(inputs);
  onTyped(*rate_, keys, [&port](int rate) { port.setBlood({rate / kMinute, BloodRequest::unchanged(), -1}); });
  onTyped(*pressure_, keys,
          [&port](int pressure) {
            port.setBlood({BloodRequest::unchanged(), pressure * kMillimetreOfMercury, -1});
          });
}

void PressureBox::showBlood(const BloodState& blood, bool is_played)
{
  trace_->showBlood(blood);
  values_->setText(pressureText(blood));
  ratio_->setText(ratioText(blood));
  adenosine_->setChecked(blood.hyperaemia);
  showNumber(*rate_, kMinute * blood.heart_rate);
  showNumber(*pressure_, blood.mean_pressure / kMillimetreOfMercury);
  for (QWidget* input :
       {static_cast<QWidget*>(adenosine_), static_cast<QWidget*>(rate_), static_cast<QWidget*>(pressure_)})
    input->setEnabled(!is_played);
}

}  // namespace endovascular_sim::rviz_plugin
