#include "rviz_plugin/widget/quit_shortcut.h"

#include <QAction>
#include <QKeySequence>
#include <QMainWindow>

namespace endovascular_sim::rviz_plugin
{

void closeByCtrlQ(QMainWindow& window)
{
  const QKeySequence keys("Ctrl+Q");
  QAction* quit = nullptr;
  for (QAction* action : window.findChildren<QAction*>())
    if (action->shortcut() == keys)
      quit = action;
  if (quit == nullptr)
  {
    quit = new QAction("Quit", &window);
    quit->setShortcut(keys);
    QObject::connect(quit, &QAction::triggered, &window, &QWidget::close);
  }
  quit->setShortcutContext(Qt::ApplicationShortcut);  // also from a dialog of the window
  if (!window.actions().contains(quit))
    window.addAction(quit);
}

}  // namespace endovascular_sim::rviz_plugin
