#pragma once

#include <cstddef>
#include <cstdint>
#include <string>

#include <ros/ros.h>

#include "endovascular_sim/ContrastCells.h"
#include "endovascular_sim/ContrastInjection.h"
#include "endovascular_sim/InjectContrast.h"
#include "session/session.h"

namespace endovascular_sim::nodes
{

/** Contrast medium in the graph: its cells, and the inputs of the simulation, those of the service contrast/inject and
 * of the procedure. A recording holds the topic contrast/injection, so that its replay has the same inputs in the same
 *  steps. */
class GraphContrast
{
public:
  /** Publishes the cells. @param session of a scene with contrast medium */
  GraphContrast(ros::NodeHandle& node, const session::Session& session);

  /** Begins a run. @param run its number */
  void beginRun(const session::Session& session, std::uint32_t run);

  /** Executes a call between two steps.
   *  @return what is injected
   *  @throws InputError for what is impossible; nothing changes */
  static std::string inject(session::Session& session, const InjectContrast::Request& request);

  /** Publishes the inputs that were not published yet. */
  void publishInputs(const session::Session& session, ros::Time stamp);

private:
  ros::Publisher cells_, injection_;
  ContrastInjection message_;
  std::uint64_t step_ = 0;     ///< of the newest inputs that were published
  std::size_t published_ = 0;  ///< number of them
};

}  // namespace endovascular_sim::nodes
