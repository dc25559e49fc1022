#pragma once

/** Private parameters in which the session node stores its recording, so that it continues when the node is started
 * again. */
namespace endovascular_sim::nodes::session_parameters
{

constexpr auto kFolder = "recording/folder";         ///< folder of the session
constexpr auto kRunFolder = "recording/run_folder";  ///< folder of the present run, below it or the same
constexpr auto kRun = "recording/run";               ///< number of the present run; 0: not known yet
constexpr auto kStopped = "recording/stopped";       ///< true after session/stop
constexpr auto kSubject = "subject";                 ///< pseudonym of the trainee

}  // namespace endovascular_sim::nodes::session_parameters
