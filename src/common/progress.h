#pragma once

#include <functional>
#include <string>

namespace endovascular_sim
{

/** Receiver of the progress of a long computation: its present task, and the completed fraction of this task in [0, 1].
 *  Called from the computing thread, up to thousands of times per second; it must not change the computation. */
using ProgressReport = std::function<void(const char* task, double fraction)>;

/** Passes progress on, if there is a receiver. */
inline void reportProgress(const ProgressReport& receiver, const char* task, double fraction = 0.0)
{
  if (receiver)
    receiver(task, fraction);
}

/** Progress as lines of text such as "centreline: 40 %": the first one after a second, then at most one every two
 *  seconds. Short computations print nothing.
 *  @param print receives the lines */
ProgressReport progressLines(std::function<void(const std::string& line)> print);

/** Progress lines on the error stream. */
ProgressReport progressOnErrorStream();

}  // namespace endovascular_sim
