#pragma once

#include <functional>

#include <QString>

class QAbstractSpinBox;
class QLabel;
class QPushButton;
class QSpinBox;
class QWidget;

namespace endovascular_sim::rviz_plugin
{

/** Button of the panel, which never takes the focus: keys stay with the panel.
 *  @param name of the object, for tests and style sheets
 *  @param clicked called at each click; empty: nothing */
QPushButton* panelButton(const QString& text, const QString& name, std::function<void()> clicked = {});

/** Label of plain text; "–" at first. Its text has no effect on the width of the panel.
 *  @param name of the object */
QLabel* panelLabel(const QString& name);

/** Box of a whole number, which takes the focus by a click only.
 *  @param name of the object
 *  @param unit after the number, e.g. " mmHg" */
QSpinBox* numberBox(const QString& name, const QString& unit, int low, int high);

/** Makes a button as narrow as its text: its row has room in a panel that is as wide as its other rows. */
void makeNarrow(QPushButton& button);

/** Makes a box of a number as narrow as its widest text with its unit. */
void makeNarrow(QAbstractSpinBox& box, const QString& widest);

/** Shows a value unless somebody types another one. */
void showNumber(QSpinBox& box, double value);

/** Calls a function with a number that was typed and ended by Enter.
 *  @param keys takes the focus then */
void onTyped(QSpinBox& box, QWidget& keys, std::function<void(int)> take);

/** Removes the margins of a layout and sets its spacing to that of the panel. @return the layout */
template <typename Layout>
Layout* compact(Layout* layout)
{
  layout->setContentsMargins(0, 0, 0, 0);
  layout->setSpacing(3);
  return layout;
}

}  // namespace endovascular_sim::rviz_plugin
