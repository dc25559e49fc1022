#include "rviz_plugin/picture/lesson_layout.h"

#include <algorithm>

#include <gtest/gtest.h>

namespace endovascular_sim::rviz_plugin
{
namespace
{

struct Screen
{
  int width, height;
};

TEST(LessonLayout, TheXRayImageIsAtLeastAsLargeAsTheView)
{
  for (const Screen screen : {Screen{1280, 800}, Screen{1920, 1080}, Screen{1024, 768}, Screen{1366, 768},
                              Screen{3840, 2160}, Screen{1600, 1200}})
  {
    const LessonColumns columns = lessonColumns(screen.width, screen.height, lessonFontScale(screen.height));
    EXPECT_EQ(columns.panel + columns.view + columns.x_ray, screen.width);
    const double side = std::min(columns.x_ray, screen.height);
    EXPECT_GE(side, columns.view) << screen.width;
    EXPECT_GE(side * side, 1.0 * columns.view * screen.height) << screen.width;
    EXPECT_GT(columns.view, 200) << screen.width;
  }
}

TEST(LessonLayout, FontsFollowTheHeightOfTheScreen)
{
  EXPECT_EQ(lessonFontScale(800), 1.0);
  EXPECT_EQ(lessonFontScale(600), 1.0);
  EXPECT_NEAR(lessonFontScale(1080), 1.35, 1e-9);
  EXPECT_EQ(lessonFontScale(4320), 2.0);
  EXPECT_LE(lessonColumns(1024, 768, 3.0).panel, 0.4 * 1024);
}

}  // namespace
}  // namespace endovascular_sim::rviz_plugin
