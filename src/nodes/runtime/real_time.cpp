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

/** The last processor that this thread may use, and all that it may use. */
int lastCpu(cpu_set_t& allowed)
{
  CPU_ZERO(&allowed);
  if (sched_getaffinity(0, sizeof allowed, &allowed) != 0)
    return -1;
  int last = CPU_SETSIZE - 1;
  while (last > 0 && !CPU_ISSET(last, &allowed))
    --last;
  return last;
}

/** Keeps this thread and its children on the last processor; returns its number, or −1 when that was refused. */
int stayOnLastCpu()
{
  cpu_set_t allowed;
  const int last = lastCpu(allowed);
  cpu_set_t chosen;
  CPU_ZERO(&chosen);
  if (last >= 0)
    CPU_SET(last, &chosen);
  if (last < 0 || sched_setaffinity(0, sizeof chosen, &chosen) != 0)
    return -1;
  return last;
}

}  // namespace

RealTimeGrant askForRealTime(int priority)
{
  sched_param parameters{};
  parameters.sched_priority = priority;
  if (sched_setscheduler(0, SCHED_FIFO, &parameters) != 0)
    return {false,
            std::string("real-time scheduling was refused (") + std::strerror(errno) +
                "): steps will be late when the machine is busy. Allow it with a line 'ACCOUNT " +
                "- rtprio 80' in /etc/security/limits.d/90-endovascular-sim.conf and log in again, or run as root"};
  std::string message =
      "SCHED_FIFO, priority " + std::to_string(priority) + ", processor " + std::to_string(stayOnLastCpu());
  if (mlockall(MCL_CURRENT | MCL_FUTURE) != 0)
    message += std::string("; memory is not locked (") + std::strerror(errno) + "): raise 'memlock' in limits.d";
  return {true, message};
}

double shareToLeave()
{
  constexpr double kMargin = 0.02;  // what shares the processor works while the loop rests
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
  return pthread_setschedparam(pthread_self(), SCHED_FIFO, &parameters) == 0;
}

void keepOffLockStepCpu()
{
  cpu_set_t allowed;
  const int last = lastCpu(allowed);
  if (last < 0 || CPU_COUNT(&allowed) < 2)
    return;
  CPU_CLR(last, &allowed);
  sched_setaffinity(0, sizeof allowed, &allowed);
}

void spinUntilShutdown()
{
  const ros::WallDuration patience(0.1);
  while (ros::ok() && !ros::isShuttingDown())
    ros::getGlobalCallbackQueue()->callAvailable(patience);
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
