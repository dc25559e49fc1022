#pragma once

#include <functional>

#include <ros/node_handle.h>

#include "nodes/runtime/real_time.h"

namespace endovascular_sim::nodes
{

/** Scheduling classes of the nodes. All but kLockStep leave the processor of the lock-step nodes to these. */
enum class NodeScheduling
{
  kDefault,   ///< ordinary scheduling
  kIdle,      ///< SCHED_IDLE
  kRealTime,  ///< SCHED_FIFO
  kLockStep,  ///< SCHED_FIFO on the processor that the rod and the contact node share, memory locked
};

/** Name and scheduling of a node's process. */
struct NodeProgram
{
  const char* name;  ///< default name of the node
  NodeScheduling scheduling = NodeScheduling::kDefault;
  int priority = 0;  ///< real-time priority, 1 to 99; unused without one
};

/** Requests the scheduling of the node's program and logs the result. A node calls it once, after its set-up. */
using SchedulingRequest = std::function<SchedulingGrant()>;

/** Main function of a node: claims the session's processor, initialises ROS and runs the node.
 *
 *  The processes of a session share one claim on the processor of its real-time nodes; see ProcessorClaim. A watchdog
 *  gives up real-time scheduling when the node makes no progress; see countProgress(). An exception ends the process
 *  with a log line and exit code 1. Log lines of nodes contain no name of their node: the launch files set
 *  ROSCONSOLE_FORMAT, which prints it.
 *  @param run constructs the node, requests its scheduling, and returns when it has ended; false: it failed
 *  @return exit code */
int runNode(int argc, char** argv, const NodeProgram& program,
            const std::function<bool(ros::NodeHandle& node, const SchedulingRequest& request)>& run);

/** True from the arrival of SIGINT. ros::ok() reports it up to 0.1 s later, too late for a force at the hand. */
bool isStopRequested();

/** Counts an iteration of a real-time loop for the process's watchdog. Callable from any thread. */
void countProgress();

}  // namespace endovascular_sim::nodes
