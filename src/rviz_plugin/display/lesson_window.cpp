#include "rviz_plugin/display/lesson_window.h"

#include <QApplication>
#include <QDockWidget>
#include <QMainWindow>
#include <QMenuBar>
#include <QScreen>
#include <QShortcut>
#include <QStatusBar>
#include <QTimer>
#include <QToolBar>

#include "rviz_plugin/picture/lesson_layout.h"
#include "rviz_plugin/widget/font_scale.h"
#include "rviz_plugin/widget/quit_shortcut.h"

namespace endovascular_sim::rviz_plugin
{
namespace
{

constexpr auto kMenu = "lesson_menu";  // name of a shortcut
constexpr int kSettling = 500;         // time until the window has its size [ms]

void resizeColumns(QMainWindow& window)
{
  QDockWidget *session = nullptr, *x_ray = nullptr;
  for (QDockWidget* dock : window.findChildren<QDockWidget*>())
  {
    if (dock->windowTitle() == "Session")
      session = dock;
    else if (dock->windowTitle() == "X-ray")
      x_ray = dock;
  }
  if (session == nullptr || x_ray == nullptr)
    return;
  window.addDockWidget(Qt::LeftDockWidgetArea, session);
  window.addDockWidget(Qt::RightDockWidgetArea, x_ray);
  const LessonColumns columns = lessonColumns(window.width(), window.height(), fontScale());
  window.resizeDocks({session, x_ray}, {columns.panel, columns.x_ray}, Qt::Horizontal);
}

/** Shows a window on the whole screen without menu and tools, or with them. rviz's own full screen hides the panels. */
void fill(QMainWindow& window, bool fills)
{
  window.menuBar()->setHidden(fills);
  window.statusBar()->setHidden(fills);
  for (QToolBar* tools : window.findChildren<QToolBar*>())
    tools->setHidden(fills);
  window.setWindowState(fills ? window.windowState() | Qt::WindowFullScreen
                              : window.windowState() & ~Qt::WindowFullScreen);
  if (fills)
    window.setGeometry(QApplication::primaryScreen()->geometry());  // also without a window manager
  QTimer::singleShot(kSettling, &window, [&window] { resizeColumns(window); });
}

}  // namespace

void arrangeForLesson(QWidget& part)
{
  auto* window = qobject_cast<QMainWindow*>(part.window());
  if (window == nullptr && part.parentWidget() != nullptr)
    window = qobject_cast<QMainWindow*>(part.parentWidget()->window());
  if (window == nullptr || QApplication::primaryScreen() == nullptr)
    return;
  fill(*window, true);
  closeByCtrlQ(*window);
  if (window->findChild<QShortcut*>(kMenu) != nullptr)
    return;
  auto* menu = new QShortcut(QKeySequence("F10"), window);
  menu->setObjectName(kMenu);
  QObject::connect(menu, &QShortcut::activated, window, [window] { fill(*window, !window->menuBar()->isHidden()); });
}

}  // namespace endovascular_sim::rviz_plugin
