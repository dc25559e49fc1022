#include "rviz_plugin/widget/quit_shortcut.h"

#include <gtest/gtest.h>
#include <QAction>
#include <QMainWindow>
#include <QMenuBar>
#include <QtTest/QTest>

#include "test/rviz_plugin/widget/widget_test.h"

namespace endovascular_sim::rviz_plugin
{
namespace
{

class QuitShortcutTest : public WidgetTest
{
protected:
  void show()
  {
    window.show();
    window.activateWindow();
    ASSERT_TRUE(QTest::qWaitForWindowActive(&window));
  }

  void pressCtrlQ() { QTest::keyClick(&window, Qt::Key_Q, Qt::ControlModifier); }

  QMainWindow window;
};

TEST_F(QuitShortcutTest, ClosesAWindowWhoseMenuHasIt)
{
  QAction* quit = window.menuBar()->addMenu("File")->addAction("Quit");
  quit->setShortcut(QKeySequence("Ctrl+Q"));
  QObject::connect(quit, &QAction::triggered, &window, &QWidget::close);
  for (const bool belongs_to_the_window : {false, true})
    for (const bool is_hidden : {true, false})
    {
      if (belongs_to_the_window)
        window.addAction(quit);
      closeByCtrlQ(window);
      closeByCtrlQ(window);
      window.menuBar()->setHidden(is_hidden);
      show();
      pressCtrlQ();
      EXPECT_FALSE(window.isVisible()) << belongs_to_the_window << is_hidden;
      window.removeAction(quit);
    }
}

TEST_F(QuitShortcutTest, ClosesAWindowWithoutAMenu)
{
  closeByCtrlQ(window);
  show();
  pressCtrlQ();
  EXPECT_FALSE(window.isVisible());
}

}  // namespace
}  // namespace endovascular_sim::rviz_plugin
