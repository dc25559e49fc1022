#pragma once

#include <chrono>
#include <string>

namespace endovascular_sim::nodes
{

/** What the operating system said to a wish for real-time scheduling. */
struct RealTimeGrant
{
  bool granted = false;
  std::string message;  ///< for people: what is in force, or why not and what to do
};

/** Asks for SCHED_FIFO and locked memory for this thread and all that it starts later; call it before ros::init.
 *
 *  Where that is granted, all of them stay on the last of the allowed processors. The rod and the contact node work in
 *  turns, never at once; on one processor each turn is a switch between threads, on two it is an interrupt from one to
 * the other, which costs several times as much, most of all in a virtual machine.
 *  @param priority 1 to 99 */
RealTimeGrant askForRealTime(int priority);

/** What real-time scheduling must leave of a processor's time, or Linux stops it there for a while: from
 *  `kernel.sched_rt_runtime_us`; 0 where there is no such limit. */
double shareToLeave();

/** SCHED_FIFO for the calling thread and those that it starts later, wherever they run. @return whether it was granted
 */
bool makeThreadRealTime(int priority);

/** Leaves that processor to the rod and the contact node, where this process has another one. Call it before ros::init.
 */
void keepOffLockStepCpu();

/** ros::spin() for a process with real-time scheduling. The original turns round without rest while ROS shuts down,
 * which keeps from ending, on one processor, the threads that are waited for. To be ended by a signal or by
 * ros::requestShutdown(). */
void spinUntilShutdown();

/** Back to ordinary scheduling for the calling thread (diagnostics, files). */
void leaveRealTime();

/** Sleeps until a point of the steady clock; returns at once when it has passed. */
void sleepUntil(std::chrono::steady_clock::time_point time);

}  // namespace endovascular_sim::nodes
