#pragma once

namespace endovascular_sim::rviz_plugin
{

/** Widths of the three columns of a lesson: panel, view of the vessel, X-ray image [pixels]. */
struct LessonColumns
{
  int panel = 0, view = 0, x_ray = 0;
};

/** Columns of a lesson in a window. The X-ray image is a square, at least as large as the view of the vessel.
 *  @param width, height of the window [pixels]
 *  @param font_scale of the panel's letters */
LessonColumns lessonColumns(int width, int height, double font_scale);

/** Scale of fonts of a lesson on a screen. @param height [pixels] */
double lessonFontScale(int height);

}  // namespace endovascular_sim::rviz_plugin
