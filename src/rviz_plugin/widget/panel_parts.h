#pragma once

#include <functional>

#include <QString>

class QLabel;
class QPushButton;

namespace endovascular_sim::rviz_plugin
{

/** Button of the panel, which never takes the focus: keys stay with the panel.
 *  @param name of the object, for tests and style sheets
 *  @param clicked called at each click; empty: nothing */
QPushButton* panelButton(const QString& text, const QString& name, std::function<void()> clicked = {});

/** Label of plain text; "–" at first. Its text has no effect on the width of the panel.
 *  @param name of the object */
QLabel* panelLabel(const QString& name);

/** Removes the margins of a layout and sets its spacing to that of the panel. @return the layout */
template <typename Layout>
Layout* compact(Layout* layout)
{
  layout->setContentsMargins(0, 0, 0, 0);
  layout->setSpacing(3);
  return layout;
}

}  // namespace endovascular_sim::rviz_plugin
