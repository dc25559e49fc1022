#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdio>
#include <iterator>
#include <sstream>
#include <string>
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

/** Processors of a list of Linux, e.g. "0-2,5"; empty for another text. */
inline std::vector<int> processorsOfList(const std::string& text)
{
  constexpr int kMost = 4096;
  std::vector<int> processors;
  std::istringstream stream(text);
  for (std::string part; std::getline(stream, part, ',');)
  {
    int first = 0;
    int last = 0;
    const int numbers = std::sscanf(part.c_str(), "%d-%d", &first, &last);
    last = numbers == 1 ? first : last;
    if (numbers < 1 || first < 0 || last >= kMost)
      return {};
    for (; first <= last; ++first)
      processors.push_back(first);
  }
  return processors;
}

/** Processors for the other work of a session: all but the loop's, and with at least two left also none of the same
 *  core, whose threads share its arithmetic units. With the loop's processor alone there is no choice.
 *  @param allowed processors of this process
 *  @param loop processor of the real-time nodes
 *  @param core processors of the loop's core, the loop's included */
inline std::vector<int> processorsBesideLoop(const std::vector<int>& allowed, int loop, const std::vector<int>& core)
{
  const auto without = [&allowed](const std::vector<int>& excluded)
  {
    std::vector<int> left;
    std::copy_if(allowed.begin(), allowed.end(), std::back_inserter(left),
                 [&excluded](int one) { return std::find(excluded.begin(), excluded.end(), one) == excluded.end(); });
    return left;
  };
  std::vector<int> others = without(core);
  if (others.size() < 2)
    others = without({loop});
  return others.empty() ? allowed : others;
}

}  // namespace endovascular_sim::nodes
