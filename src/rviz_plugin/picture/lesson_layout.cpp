#include "rviz_plugin/picture/lesson_layout.h"

#include <algorithm>
#include <cmath>

namespace endovascular_sim::rviz_plugin
{
namespace
{

constexpr double kPanelWidth = 300.0;   // with usual fonts [pixels]
constexpr double kLargestPanel = 0.4;   // relative to the width of the window
constexpr double kXRayShare = 0.6;      // of the width beside the panel
constexpr double kUsualHeight = 800.0;  // of a screen with usual fonts [pixels]

}  // namespace

LessonColumns lessonColumns(int width, int height, double font_scale)
{
  LessonColumns columns;
  columns.panel = static_cast<int>(std::min(kPanelWidth * font_scale, kLargestPanel * width));
  const int rest = width - columns.panel;
  // Square of equal area beside the view: x² = (rest − x) height.
  const double square = 0.5 * (std::sqrt(height * (height + 4.0 * rest)) - height);
  columns.x_ray = static_cast<int>(std::ceil(std::max(kXRayShare * rest, square)));
  // A wide window: a larger image would only have a wider rim.
  columns.x_ray = std::max(std::min(columns.x_ray, height), (rest + 1) / 2);
  columns.view = rest - columns.x_ray;
  return columns;
}

double lessonFontScale(int height)
{
  return std::clamp(height / kUsualHeight, 1.0, 2.0);
}

}  // namespace endovascular_sim::rviz_plugin
