#pragma once

#include <pthread.h>

namespace endovascular_sim::nodes
{

/** Mutex with priority inheritance: its holder runs at the highest priority of the threads that wait for it.
 *
 *  A real-time thread therefore waits no longer than the critical section takes, however busy the machine is. Meets the
 *  requirements of std::lock_guard. */
class PriorityInheritanceMutex
{
public:
  PriorityInheritanceMutex()
  {
    pthread_mutexattr_t attributes;
    pthread_mutexattr_init(&attributes);
    pthread_mutexattr_setprotocol(&attributes, PTHREAD_PRIO_INHERIT);
    pthread_mutex_init(&mutex_, &attributes);
    pthread_mutexattr_destroy(&attributes);
  }
  ~PriorityInheritanceMutex() { pthread_mutex_destroy(&mutex_); }
  PriorityInheritanceMutex(const PriorityInheritanceMutex&) = delete;
  PriorityInheritanceMutex& operator=(const PriorityInheritanceMutex&) = delete;

  void lock() { pthread_mutex_lock(&mutex_); }
  void unlock() { pthread_mutex_unlock(&mutex_); }

private:
  pthread_mutex_t mutex_{};
};

}  // namespace endovascular_sim::nodes
