#include "rviz_plugin/widget/motion_box.h"

#include <cmath>

#include <QHBoxLayout>
#include <QLabel>
#include <QPushButton>
#include <QSpinBox>
#include <QVBoxLayout>

#include "motion/body/motion_settings.h"
#include "rviz_plugin/model/session_port.h"
#include "rviz_plugin/widget/panel_parts.h"

namespace endovascular_sim::rviz_plugin
{
namespace
{

constexpr double kMinute = 60.0;  // [s]

int perMinute(double rate)
{
  return static_cast<int>(std::lround(kMinute * rate));
}

const char* breathText(const MotionStatus& motion)
{
  if (motion.is_holding)
    return motion.controls.breath_held ? "breath held" : "breathing again";
  return motion.controls.breath_held ? "breathing out to hold" : "breathing";
}

}  // namespace

QString phaseText(const MotionStatus& motion)
{
  const char* heart = motion.heart_rate <= 0.0 ? "arrest" : motion.systole ? "systole" : "diastole";
  return QString("Heart and breath: %1, %2").arg(heart, breathText(motion));
}

MotionBox::MotionBox(SessionPort& port, QWidget& keys)
{
  auto* layout = compact(new QVBoxLayout(this));
  phases_ = panelLabel("phases");
  layout->addWidget(phases_);
  auto* inputs = compact(new QHBoxLayout);
  hold_ = panelButton(
      "Hold breath", "hold_breath",
      [this, &port] {
        port.setMotion({MotionRequest::unchanged(), MotionRequest::unchanged(), hold_->isChecked() ? 1 : 0});
      });
  hold_->setCheckable(true);
  hold_->setToolTip("the patient holds the breath from the next end of an expiration on");
  heart_ = numberBox("beats", " /min", perMinute(motion::kLeastHeartRate), perMinute(motion::kLargestHeartRate));
  breath_ = numberBox("breaths", " /min", static_cast<int>(std::ceil(kMinute * motion::kLeastBreathingRate)),
                      perMinute(motion::kLargestBreathingRate));
  breath_->setSingleStep(1);
  breath_->setToolTip("breaths per minute, from the next breath on; type a number, then Enter");
  inputs->addWidget(hold_);
  inputs->addWidget(heart_, 1);
  inputs->addWidget(breath_, 1);
  layout->addLayout(inputs);
  onTyped(*heart_, keys, [&port](int rate) { port.setMotion({rate / kMinute, MotionRequest::unchanged(), -1}); });
  onTyped(*breath_, keys, [&port](int rate) { port.setMotion({MotionRequest::unchanged(), rate / kMinute, -1}); });
}

void MotionBox::showMotion(const MotionStatus& motion, bool has_flow, bool is_played)
{
  phases_->setText(phaseText(motion));
  hold_->setChecked(motion.controls.breath_held);
  hold_->setEnabled(!is_played);
  breath_->setEnabled(!is_played);
  heart_->setEnabled(!is_played && !has_flow);
  heart_->setToolTip(has_flow ? "the flow of blood sets the heart rate: change it below the pressures"
                              : "heart rate, from the next beat on; type a number, then Enter");
  showNumber(*heart_, kMinute * (has_flow ? motion.heart_rate : motion.controls.heart_rate));
  showNumber(*breath_, kMinute * motion.controls.breathing_rate);
}

}  // namespace endovascular_sim::rviz_plugin
