#pragma once

#include <atomic>
#include <chrono>
#include <cstddef>
#include <functional>
#include <memory>
#include <string>

namespace endovascular_sim::nodes
{

/** Scheduling that the operating system granted to a process. */
struct SchedulingGrant
{
  bool granted = true;
  std::string message = "default";  ///< scheduling that was granted; when refused, the reason and the remedy
  /** True from the moment in which the watchdog withdrew the scheduling; see ProgressWatchdog. */
  std::shared_ptr<const std::atomic<bool>> withdrawn;
  /** Number of other sessions with real-time nodes on the same processor at present. */
  std::function<std::size_t()> other_sessions = [] { return std::size_t{0}; };

  /** True if the requested scheduling was granted and not withdrawn. Callable from any thread. */
  bool isInForce() const;
  /** Scheduling in force at present; when refused or withdrawn, the reason and the remedy. Callable from any thread. */
  std::string describe() const;
};

/** Requests SCHED_FIFO and locked memory for all present threads of the process and those that they start later. Call
 *  it after set-up, so that a node that waits or fails before has ordinary scheduling.
 *  @param priority 1 to 99 */
SchedulingGrant requestLockStepScheduling(int priority);

/** Requests SCHED_FIFO for all present threads of the process and those that they start later. Call it after set-up. */
SchedulingGrant requestRealTimeScheduling(int priority);

/** Restores ordinary scheduling for all threads of the process. */
void leaveRealTimeInProcess();

/** Requests SCHED_IDLE for the calling thread and the threads that it starts later: they yield to all others. */
SchedulingGrant requestIdleScheduling();

/** Share of a processor's time that real-time threads must leave idle, from `kernel.sched_rt_runtime_us`; 0 without
 *  such a limit. Linux stops real-time threads for a while when they exceed it. */
double requiredIdleShare();

/** Sets SCHED_FIFO for the calling thread and the threads that it starts later. @return false when it was refused */
bool makeThreadRealTime(int priority);

/** Restores ordinary scheduling for the calling thread, for example for diagnostics and files. */
void leaveRealTime();

/** Restricts the calling thread, and the threads that it starts later, to one processor. Call it before ROS starts its
 *  threads.
 *
 *  The rod and the contact node run in turns, never at the same time. On one processor a turn is a switch between
 *  threads. On two it is an inter-processor interrupt, which costs several times as much, above all in a virtual
 *  machine.
 *  @return false when it was refused */
bool useProcessor(int processor);

/** Excludes a processor, if this process may use another one. Call it before ROS starts its threads. */
void avoidProcessor(int processor);

/** Equivalent of ros::spin() for a process with real-time scheduling.
 *
 *  While ROS shuts down, ros::spin() polls without sleeping. On one processor this starves the threads that the
 * shutdown waits for. Ended by a signal or by ros::requestShutdown(). */
void spinUntilShutdown();

/** Sleeps until a time of the steady clock; returns at once when it has passed. */
void sleepUntil(std::chrono::steady_clock::time_point time);

}  // namespace endovascular_sim::nodes
