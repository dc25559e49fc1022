#include "nodes/runtime/real_time.h"

#include <dirent.h>
#include <pthread.h>
#include <sched.h>
#include <sys/mman.h>
#include <time.h>

#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <string>

#include <ros/callback_queue.h>
#include <ros/ros.h>

#include "nodes/runtime/processor/processor_claim.h"

namespace endovascular_sim::nodes
{
namespace
{

/** Sets a policy for every thread of the process. A thread that ends meanwhile is no failure.
 *  @return false when one was refused; errno is then the reason */
bool setPolicyOfAllThreads(int policy, int priority)
{
  sched_param parameters{};
  parameters.sched_priority = priority;
  DIR* const tasks = opendir("/proc/self/task");
  if (tasks == nullptr)
    return false;
  int failure = 0;
  while (const dirent* const task = readdir(tasks))
  {
    const int thread = std::atoi(task->d_name);
    if (thread > 0 && sched_setscheduler(thread, policy, &parameters) != 0 && errno != ESRCH)
      failure = errno;
  }
  closedir(tasks);
  errno = failure;
  return failure == 0;
}

SchedulingGrant refusal(const std::string& consequence, const std::string& remedy)
{
  SchedulingGrant grant;
  grant.granted = false;
  grant.message = std::string("refused (") + std::strerror(errno) + "): " + consequence + "; " + remedy;
  return grant;
}

constexpr auto kRealTimeRemedy =
    "allow it with a line 'ACCOUNT - rtprio 80' in "
    "/etc/security/limits.d/90-endovascular-sim.conf and log in again, or run as root";

}  // namespace

bool SchedulingGrant::isInForce() const
{
  return granted && !(withdrawn && *withdrawn);
}

std::string SchedulingGrant::describe() const
{
  if (!granted || isInForce())
    return message;
  return "withdrawn (the loop made no progress): ordinary scheduling until the node restarts; it was " + message;
}

SchedulingGrant requestLockStepScheduling(int priority)
{
  if (!setPolicyOfAllThreads(SCHED_FIFO, priority))
    return refusal("steps are late when the machine is busy", kRealTimeRemedy);
  std::string message = "SCHED_FIFO, priority " + std::to_string(priority);
  if (mlockall(MCL_CURRENT | MCL_FUTURE) != 0)
    message += std::string("; memory is not locked (") + std::strerror(errno) + "): raise 'memlock' in limits.d";
  SchedulingGrant grant;
  grant.message = message;
  return grant;
}

SchedulingGrant requestRealTimeScheduling(int priority)
{
  if (!setPolicyOfAllThreads(SCHED_FIFO, priority))
    return refusal("forces are late when the machine is busy", kRealTimeRemedy);
  SchedulingGrant grant;
  grant.message = "SCHED_FIFO, priority " + std::to_string(priority);
  return grant;
}

void leaveRealTimeInProcess()
{
  setPolicyOfAllThreads(SCHED_OTHER, 0);
}

SchedulingGrant requestIdleScheduling()
{
  const sched_param parameters{};
  if (sched_setscheduler(0, SCHED_IDLE, &parameters) != 0)
    return refusal("SCHED_IDLE is not in force and this node may delay the simulation",
                   "start it with `chrt --idle 0` or `nice -n 19`");
  SchedulingGrant grant;
  grant.message = "SCHED_IDLE";
  return grant;
}

double requiredIdleShare()
{
  constexpr double kMargin = 0.02;  // work of other threads on the processor while the loop sleeps
  double runtime = -1.0;
  double period = 0.0;
  std::ifstream("/proc/sys/kernel/sched_rt_runtime_us") >> runtime;
  std::ifstream("/proc/sys/kernel/sched_rt_period_us") >> period;
  return runtime < 0.0 || !(runtime < period) ? 0.0 : 1.0 - runtime / period + kMargin;
}

bool makeThreadRealTime(int priority)
{
  sched_param parameters{};
  parameters.sched_priority = priority;
  errno = pthread_setschedparam(pthread_self(), SCHED_FIFO, &parameters);
  return errno == 0;
}

bool useProcessor(int processor)
{
  cpu_set_t chosen;
  CPU_ZERO(&chosen);
  if (processor < 0 || processor >= CPU_SETSIZE)
    return false;
  CPU_SET(processor, &chosen);
  return sched_setaffinity(0, sizeof chosen, &chosen) == 0;
}

void avoidProcessor(int processor)
{
  if (processor < 0)
    return;
  std::string core;
  std::getline(
      std::ifstream("/sys/devices/system/cpu/cpu" + std::to_string(processor) + "/topology/thread_siblings_list"),
      core);
  cpu_set_t chosen;
  CPU_ZERO(&chosen);
  for (const int other : processorsBesideLoop(allowedProcessors(), processor, processorsOfList(core)))
    CPU_SET(other, &chosen);
  if (CPU_COUNT(&chosen) > 0)
    sched_setaffinity(0, sizeof chosen, &chosen);
}

void spinUntilShutdown()
{
  const ros::WallDuration timeout(0.1);
  while (ros::ok() && !ros::isShuttingDown())
    ros::getGlobalCallbackQueue()->callAvailable(timeout);
}

void leaveRealTime()
{
  const sched_param parameters{};
  pthread_setschedparam(pthread_self(), SCHED_OTHER, &parameters);
}

void sleepUntil(std::chrono::steady_clock::time_point time)
{
  const auto since_boot = time.time_since_epoch();
  const auto seconds = std::chrono::duration_cast<std::chrono::seconds>(since_boot);
  timespec target{};
  target.tv_sec = seconds.count();
  target.tv_nsec = std::chrono::duration_cast<std::chrono::nanoseconds>(since_boot - seconds).count();
  while (clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &target, nullptr) == EINTR)
  {
  }
}

}  // namespace endovascular_sim::nodes
