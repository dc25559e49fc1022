#pragma once

#include <cstdlib>

#include <gtest/gtest.h>
#include <QApplication>

namespace endovascular_sim::rviz_plugin
{

/** Tests of widgets, which need an application; it draws without a screen. */
class WidgetTest : public ::testing::Test
{
protected:
  static void SetUpTestSuite()
  {
    setenv("QT_QPA_PLATFORM", "offscreen", 1);
    static int count = 1;
    static char name[] = "test_rviz_plugin";
    static char* arguments[] = {name, nullptr};
    if (QApplication::instance() == nullptr)
      new QApplication(count, arguments);  // lives as long as the program
  }
};

}  // namespace endovascular_sim::rviz_plugin
