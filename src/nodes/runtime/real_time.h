#pragma once

#include <chrono>
#include <string>

namespace endovascular_sim::nodes
{

/** Scheduling that the operating system granted to a process. */
struct SchedulingGrant
{
  bool granted = true;
  std::string message = "default";  ///< scheduling in force; when refused, the reason and the remedy
};

/** Requests SCHED_FIFO and locked memory for the calling thread and all threads that it starts later; call it before
 *  ros::init.
 *
 *  When granted, all of them stay on the last allowed processor. The rod and the contact node run in turns, never at
 * the same time. On one processor a turn is a switch between threads. On two it is an inter-processor interrupt, which
 *  costs several times as much, above all in a virtual machine.
 *  @param priority 1 to 99 */
SchedulingGrant requestLockStepScheduling(int priority);

/** Requests SCHED_FIFO for the calling thread and the threads that it starts later, on any processor. */
SchedulingGrant requestRealTimeScheduling(int priority);

/** Requests SCHED_IDLE for the calling thread and the threads that it starts later: they yield to all others. */
SchedulingGrant requestIdleScheduling();

/** Share of a processor's time that real-time threads must leave idle, from `kernel.sched_rt_runtime_us`; 0 without
 *  such a limit. Linux stops real-time threads for a while when they exceed it. */
double requiredIdleShare();

/** Sets SCHED_FIFO for the calling thread and the threads that it starts later. @return false when it was refused */
bool makeThreadRealTime(int priority);

/** Restores ordinary scheduling for the calling thread, for example for diagnostics and files. */
void leaveRealTime();

/** Excludes the processor of the rod and the contact node, if this process may use another one. Call it before
 *  ros::init. */
void avoidLockStepProcessor();

/** Equivalent of ros::spin() for a process with real-time scheduling.
 *
 *  While ROS shuts down, ros::spin() polls without sleeping. On one processor this starves the threads that the
 * shutdown waits for. Ended by a signal or by ros::requestShutdown(). */
void spinUntilShutdown();

/** Sleeps until a time of the steady clock; returns at once when it has passed. */
void sleepUntil(std::chrono::steady_clock::time_point time);

}  // namespace endovascular_sim::nodes
