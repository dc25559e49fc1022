#pragma once

namespace rviz
{
class DisplayContext;
}

namespace endovascular_sim::rviz_plugin
{

/** Lets the window of rviz close without the question to save its configuration, if that is a copy: the launch files
 *  start rviz by rviz_window, which sets ENDOVASCULAR_RVIZ_COPY. Further calls have no effect. */
void closeWithoutQuestion(const rviz::DisplayContext& context);

}  // namespace endovascular_sim::rviz_plugin
