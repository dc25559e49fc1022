#include "rviz_plugin/widget/session_row.h"

#include <QGridLayout>
#include <QLabel>
#include <QPushButton>

#include "rviz_plugin/widget/panel_parts.h"

namespace endovascular_sim::rviz_plugin
{
SessionRow::SessionRow(SessionPort& port, QWidget& keys)
{
  const auto asking = [&port, &keys](Request request)
  {
    return [&port, &keys, request]
    {
      keys.setFocus();
      port.request(request);
    };
  };
  auto* layout = compact(new QGridLayout(this));
  layout->addWidget(panelButton("Start", "start", asking(Request::kStart)), 0, 0);
  layout->addWidget(panelButton("Pause", "pause", asking(Request::kPause)), 0, 1);
  layout->addWidget(panelButton("Reset", "reset", asking(Request::kReset)), 0, 2);
  record_ = panelButton("Record", "record",
                        [this, asking]
                        {
                          // A recording holds a run from its first step: a new one begins with a reset.
                          asking(is_recording_ ? Request::kStopRecording : Request::kReset)();
                        });
  layout->addWidget(record_, 0, 3);
  repeat_ = panelButton("Repeat", "repeat_step", asking(Request::kRepeatStep));
  repeat_->setToolTip("Returns to the beginning of this step of the lesson. A further recording begins.");
  repeat_->hide();
  layout->addWidget(repeat_, 1, 3);
  for (int column = 0; column < 4; ++column)
    layout->setColumnStretch(column, 1);
  status_ = panelLabel("status");
  recording_ = panelLabel("recording");
  layout->addWidget(status_, 1, 0);
  layout->addWidget(recording_, 1, 1, 1, 2);
}

void SessionRow::showState(const SessionState& state, const PanelTexts& texts)
{
  is_recording_ = state.is_recording;
  record_->setText(is_recording_ ? "Stop rec." : "Record");
  repeat_->setVisible(state.scene.is_guided);
  // One line: buttons below must not move under the mouse. The notice shows the reason.
  const QString status = QString::fromStdString(texts.status);
  status_->setText(status_->fontMetrics().elidedText(status, Qt::ElideRight, status_->width()));
  status_->setToolTip(texts.reason.empty() ? status : QString::fromStdString(texts.status + ": " + texts.reason));
  recording_->setText(QString::fromStdString(texts.recording));
}

}  // namespace endovascular_sim::rviz_plugin
