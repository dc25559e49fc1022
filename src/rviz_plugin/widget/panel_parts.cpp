#include "rviz_plugin/widget/panel_parts.h"

#include <cmath>
#include <utility>

#include <QAbstractSpinBox>
#include <QLabel>
#include <QPushButton>
#include <QSpinBox>

#include "rviz_plugin/widget/font_scale.h"

namespace endovascular_sim::rviz_plugin
{
namespace
{

constexpr int kButtonRim = 14;    // of a button beside its text [pixels]
constexpr int kSpinButtons = 24;  // width of the arrows beside a typed number, with its rim [pixels]

/** Gives a widget a least width, and no other effect on the width of the panel. */
void setLeastWidth(QWidget& widget, int width)
{
  widget.setMinimumWidth(width);
  widget.setSizePolicy(QSizePolicy::Ignored, QSizePolicy::Fixed);
}

}  // namespace

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

QSpinBox* numberBox(const QString& name, const QString& unit, int low, int high)
{
  auto* box = new QSpinBox;
  box->setObjectName(name);
  box->setRange(low, high);
  box->setSingleStep(5);
  box->setSuffix(unit);
  box->setFocusPolicy(Qt::ClickFocus);
  return box;
}

void makeNarrow(QPushButton& button)
{
  setLeastWidth(button, button.fontMetrics().horizontalAdvance(button.text()) + kButtonRim);
}

void makeNarrow(QAbstractSpinBox& box, const QString& widest)
{
  setLeastWidth(box, box.fontMetrics().horizontalAdvance(widest) + kSpinButtons);
}

void showNumber(QSpinBox& box, double value)
{
  if (!box.hasFocus() && box.value() != std::lround(value))
    box.setValue(static_cast<int>(std::lround(value)));
}

void onTyped(QSpinBox& box, QWidget& keys, std::function<void(int)> take)
{
  QObject::connect(&box, &QSpinBox::editingFinished, &box,
                   [&box, &keys, take = std::move(take)]
                   {
                     if (!box.hasFocus())
                       return;
                     take(box.value());
                     keys.setFocus();
                   });
}

}  // namespace endovascular_sim::rviz_plugin
