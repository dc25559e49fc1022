#include "rviz_plugin/widget/contrast_box.h"

#include <cmath>

#include <QHBoxLayout>
#include <QLabel>
#include <QPushButton>
#include <QSpinBox>
#include <QVBoxLayout>

#include "rviz_plugin/model/session_port.h"
#include "rviz_plugin/widget/panel_parts.h"

namespace endovascular_sim::rviz_plugin
{
namespace
{

constexpr double kMillilitre = 1e-6;               // [m³]
constexpr double kPuffVolume = 3.0 * kMillilitre;  // [m³]
constexpr double kPuffRate = 3.0 * kMillilitre;    // [m³/s]
constexpr int kUsualVolume = 6, kUsualRate = 4;    // of an angiogram of the left coronary artery [ml], [ml/s]

QString millilitres(double volume)
{
  return QString::number(volume / kMillilitre, 'f', 1);
}

int most(double value)
{
  return static_cast<int>(std::lround(value / kMillilitre));
}

}  // namespace

QString contrastText(const ContrastStatus& contrast)
{
  return QString("Syringe %1 ml, used %2 ml").arg(millilitres(contrast.syringe), millilitres(contrast.volume));
}

ContrastBox::ContrastBox(SessionPort& port, QWidget& keys)
{
  auto* layout = compact(new QVBoxLayout(this));
  auto* state = compact(new QHBoxLayout);
  text_ = panelLabel("contrast");
  text_->setToolTip("contrast medium: left in the syringe, and injected in this run");
  stop_ = panelButton("Stop", "stop_injection", [&port] { port.inject({}); });
  stop_->setToolTip("ends the injection; the rest stays in the syringe");
  refill_ = panelButton("Refill", "refill_syringe", [&port] { port.inject({0.0, 0.0, true}); });
  refill_->setToolTip("ends the injection and fills the syringe");
  state->addWidget(text_, 4);
  state->addWidget(stop_, 1);
  state->addWidget(refill_, 1);
  layout->addLayout(state);
  auto* inputs = compact(new QHBoxLayout);
  puff_ = panelButton("Puff", "puff", [&port] { port.inject({kPuffVolume, kPuffRate, false}); });
  puff_->setToolTip("injects 3 ml at 3 ml/s, e.g. to find an ostium");
  volume_ = numberBox("contrast_volume", " ml", 1, most(contrast::kHandSyringe.capacity));
  volume_->setToolTip("volume of Inject");
  volume_->setValue(kUsualVolume);
  rate_ = numberBox("contrast_rate", " ml/s", 1, most(contrast::kHandSyringe.fastest));
  rate_->setToolTip("rate of Inject");
  rate_->setValue(kUsualRate);
  inject_ = panelButton("Inject", "inject",
                        [this, &port] {
                          port.inject({volume_->value() * kMillilitre, rate_->value() * kMillilitre, false});
                        });
  inputs->addWidget(puff_, 2);
  inputs->addWidget(volume_, 3);
  inputs->addWidget(rate_, 3);
  inputs->addWidget(inject_, 2);
  layout->addLayout(inputs);
  makeNarrow(*volume_, "000 ml");
  makeNarrow(*rate_, "00 ml/s");
  for (QPushButton* button : {puff_, inject_, stop_, refill_})
    makeNarrow(*button);
  for (QSpinBox* box : {volume_, rate_})
    onTyped(*box, keys, [](int /*number*/) {});
}

void ContrastBox::showContrast(const ContrastStatus& contrast, const contrast::Syringe& syringe, bool is_played)
{
  text_->setText(contrastText(contrast));
  volume_->setMaximum(most(syringe.capacity));
  rate_->setMaximum(most(syringe.fastest));
  for (QWidget* input : {static_cast<QWidget*>(puff_), static_cast<QWidget*>(volume_), static_cast<QWidget*>(rate_),
                         static_cast<QWidget*>(inject_), static_cast<QWidget*>(refill_)})
    input->setEnabled(!is_played);
  stop_->setEnabled(!is_played && contrast.remaining > 0.0);
}

}  // namespace endovascular_sim::rviz_plugin
