#include "nodes/runtime/real_time.h"

#include <pthread.h>
#include <sched.h>
#include <sys/mman.h>
#include <time.h>

#include <cerrno>
#include <cstring>
#include <fstream>

#include <ros/callback_queue.h>
#include <ros/ros.h>

namespace endovascular_sim::nodes
{
namespace
{

/** Number of the last processor that this thread may use, −1 on failure. @param[out] allowed all of them */
int lastProcessor(cpu_set_t& allowed)
{
  CPU_ZERO(&allowed);
  if (sched_getaffinity(0, sizeof allowed, &allowed) != 0)
    return -1;
  int last = CPU_SETSIZE - 1;
  while (last > 0 && !CPU_ISSET(last, &allowed))
    --last;
  return last;
}

/** Moves this thread and its children to the last processor. @return its number, −1 when refused */
int moveToLastProcessor()
{
  cpu_set_t allowed;
  const int last = lastProcessor(allowed);
  cpu_set_t chosen;
  CPU_ZERO(&chosen);
  if (last >= 0)
    CPU_SET(last, &chosen);
  if (last < 0 || sched_setaffinity(0, sizeof chosen, &chosen) != 0)
    return -1;
  return last;
}

SchedulingGrant refusal(const std::string& consequence, const std::string& remedy)
{
  return {false, std::string("refused (") + std::strerror(errno) + "): " + consequence + "; " + remedy};
}

constexpr auto kRealTimeRemedy =
    "allow it with a line 'ACCOUNT - rtprio 80' in "
    "/etc/security/limits.d/90-endovascular-sim.conf and log in again, or run as root";

}  // namespace

SchedulingGrant requestLockStepScheduling(int priority)
{
  if (!makeThreadRealTime(priority))
    return refusal("steps are late when the machine is busy", kRealTimeRemedy);
  std::string message =
      "SCHED_FIFO, priority " + std::to_string(priority) + ", processor " + std::to_string(moveToLastProcessor());
  if (mlockall(MCL_CURRENT | MCL_FUTURE) != 0)
    message += std::string("; memory is not locked (") + std::strerror(errno) + "): raise 'memlock' in limits.d";
  return {true, message};
}

SchedulingGrant requestRealTimeScheduling(int priority)
{
  if (!makeThreadRealTime(priority))
    return refusal("forces are late when the machine is busy", kRealTimeRemedy);
  return {true, "SCHED_FIFO, priority " + std::to_string(priority)};
}

SchedulingGrant requestIdleScheduling()
{
  const sched_param parameters{};
  if (sched_setscheduler(0, SCHED_IDLE, &parameters) != 0)
    return refusal("SCHED_IDLE is not in force and this node may delay the simulation",
                   "start it with `chrt --idle 0` or `nice -n 19`");
  return {true, "SCHED_IDLE"};
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

void avoidLockStepProcessor()
{
  cpu_set_t allowed;
  const int last = lastProcessor(allowed);
  if (last < 0 || CPU_COUNT(&allowed) < 2)
    return;
  CPU_CLR(last, &allowed);
  sched_setaffinity(0, sizeof allowed, &allowed);
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
