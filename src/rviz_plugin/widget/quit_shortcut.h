#pragma once

class QMainWindow;

namespace endovascular_sim::rviz_plugin
{

/** Lets Ctrl+Q close a window, with and without its menu, and from its dialogs. An action with this shortcut, as of
 * rviz's menu, becomes an action of the window: two objects with one shortcut exclude each other. Further calls have no
 * effect. */
void closeByCtrlQ(QMainWindow& window);

}  // namespace endovascular_sim::rviz_plugin
