#pragma once

#include <cstddef>
#include <vector>

namespace endovascular_sim::nodes
{

/** Processor for the real-time nodes of a session, with the number of other sessions on it. */
struct ProcessorChoice
{
  int processor = -1;              ///< −1: none is allowed
  std::size_t other_sessions = 0;  ///< sessions that already use it
};

/** Chooses the processor with the fewest sessions; of equals, the last one, because interrupts and the ordinary
 *  processes of a machine prefer the first.
 *  @param allowed processors of this process
 *  @param held processor of each other session; several entries may name the same one */
inline ProcessorChoice chooseProcessor(const std::vector<int>& allowed, const std::vector<int>& held)
{
  ProcessorChoice best;
  for (const int processor : allowed)
  {
    std::size_t sessions = 0;
    for (const int other : held)
      sessions += other == processor ? 1 : 0;
    if (best.processor < 0 || sessions < best.other_sessions ||
        (sessions == best.other_sessions && processor > best.processor))
      best = {processor, sessions};
  }
  return best;
}

}  // namespace endovascular_sim::nodes
