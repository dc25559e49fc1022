#pragma once

#include <cstddef>
#include <string>

#include "rviz_plugin/model/session_state.h"

namespace endovascular_sim::rviz_plugin
{

/** Reason why an instrument does not follow its handle, for the trainee; empty if there is none.
 *  @param instrument index of the instrument
 *  @param push commanded insertion speed: its sign tells a push from a pull [m/s] */
std::string motionObstacle(const SessionState& state, std::size_t instrument, double push);

}  // namespace endovascular_sim::rviz_plugin
