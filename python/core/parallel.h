#pragma once

#include <atomic>
#include <cstddef>
#include <functional>

#include "signals.h"

namespace endovascular_sim::python
{

/** Ends a long computation on request, to be called after each of its steps: handles signals in the thread that Python
 *  called, and throws in the others after the request. */
class StepEnd
{
public:
  StepEnd(SignalCheck* signals, const std::atomic<bool>* cancelled) : signals_(signals), cancelled_(cancelled) {}

  void operator()() const;

private:
  SignalCheck* signals_;                ///< null in threads other than the one that Python called
  const std::atomic<bool>* cancelled_;  ///< null in the thread that Python called
};

/** Calls a function once for every index below a count, on several threads and without the GIL. Ctrl-C ends all of them
 *  after their present step. The threads end before the call does, so that a process can fork between two calls.
 *  @param threads number of threads; 0: one per processor
 *  @param function receives the index, and the function to be called after each step */
void runParallel(std::size_t count, int threads, const std::function<void(std::size_t, const StepEnd&)>& function);

}  // namespace endovascular_sim::python
