#pragma once

#include <exception>

#include <rviz/display.h>

namespace endovascular_sim::rviz_plugin
{

/** Runs a callback of a display. No exception leaves it: rviz would end. The display shows an error in its place. */
template <typename Callback>
void guarded(rviz::Display& display, const Callback& callback)
{
  try
  {
    callback();
  }
  catch (const std::exception& error)
  {
    display.setStatus(rviz::StatusProperty::Error, "Drawing", QString::fromUtf8(error.what()));
  }
  catch (...)  // NOLINT: the last frame before rviz
  {
    display.setStatus(rviz::StatusProperty::Error, "Drawing", "unknown error");
  }
}

}  // namespace endovascular_sim::rviz_plugin
