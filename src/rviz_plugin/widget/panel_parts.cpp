#include "rviz_plugin/widget/panel_parts.h"

#include <utility>

#include <QLabel>
#include <QPushButton>

#include "rviz_plugin/widget/font_scale.h"

namespace endovascular_sim::rviz_plugin
{

QPushButton* panelButton(const QString& text, const QString& name, std::function<void()> clicked)
{
  auto* button = new QPushButton(text);
  button->setObjectName(name);
  button->setFocusPolicy(Qt::NoFocus);
  if (clicked)
    QObject::connect(button, &QPushButton::clicked, button, [clicked = std::move(clicked)] { clicked(); });
  return button;
}

QLabel* panelLabel(const QString& name)
{
  auto* label = new QLabel("–");
  label->setObjectName(name);
  label->setTextFormat(Qt::PlainText);
  label->setFont(scaledFont(label->font()));  // a label with a style sheet does not take the font of its parent
  label->setSizePolicy(QSizePolicy::Ignored, QSizePolicy::Preferred);  // texts do not change the width of the panel
  return label;
}

}  // namespace endovascular_sim::rviz_plugin
