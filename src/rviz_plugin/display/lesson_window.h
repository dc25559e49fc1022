#pragma once

class QWidget;

namespace endovascular_sim::rviz_plugin
{

/** Arranges the window of rviz for a lesson: the whole screen without menu and tools; panel, vessel and X-ray image
 * side by side (lessonColumns()). F10 shows and hides menu and tools, Ctrl+Q
 * closes the window.
 *  @param part a part of the window */
void arrangeForLesson(QWidget& part);

}  // namespace endovascular_sim::rviz_plugin
