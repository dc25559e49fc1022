#pragma once

#include <string>

namespace endovascular_sim::nodes
{

/** Ends another node of the graph, as `rosnode kill` does.
 *  @param name relative to the namespace of this process
 *  @param patience longest wait for a node that has not started yet [s]
 *  @return false when there is no such node, or it does not respond */
bool shutDownNode(const std::string& name, const std::string& reason, double patience);

}  // namespace endovascular_sim::nodes
