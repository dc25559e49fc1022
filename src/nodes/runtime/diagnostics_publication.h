#pragma once

#include <exception>

#include <diagnostic_updater/diagnostic_updater.h>
#include <ros/console.h>

namespace endovascular_sim::nodes
{

/** Publishes diagnostics. Another node may publish any /clock: at its ends no further time can be computed, which
 *  diagnostic_updater reports by an exception. */
inline void publishDiagnostics(diagnostic_updater::Updater& diagnostics)
{
  try
  {
    diagnostics.force_update();
  }
  catch (const std::exception& error)
  {
    ROS_WARN_ONCE("diagnostics cannot be published at this time: %s", error.what());
  }
}

}  // namespace endovascular_sim::nodes
