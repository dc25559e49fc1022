#include "rviz_plugin/widget/subject_row.h"

#include <QHBoxLayout>
#include <QLabel>
#include <QLineEdit>

#include "rviz_plugin/model/session_port.h"
#include "rviz_plugin/widget/panel_parts.h"

namespace endovascular_sim::rviz_plugin
{

SubjectRow::SubjectRow(SessionPort& port, QWidget& keys) : text_(new QLineEdit)
{
  constexpr int kLongest = 50;  // of a pseudonym [characters]: at most 200 bytes
  auto* layout = compact(new QHBoxLayout(this));
  layout->addWidget(new QLabel("Trainee"));
  text_->setObjectName("subject");
  text_->setMaxLength(kLongest);
  text_->setPlaceholderText("pseudonym, then Enter");
  text_->setFocusPolicy(Qt::ClickFocus);
  layout->addWidget(text_, 1);
  connect(text_, &QLineEdit::returnPressed, text_,
          [this, &port, &keys]
          {
            port.setSubject(text_->text().toStdString());
            keys.setFocus();
          });
}

void SubjectRow::showSubject(const std::string& subject)
{
  const QString text = QString::fromStdString(subject);
  if (!text_->hasFocus() && text_->text() != text)
    text_->setText(text);
}

}  // namespace endovascular_sim::rviz_plugin
