#include "common/progress.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <iostream>
#include <utility>

namespace endovascular_sim
{
namespace
{

using Clock = std::chrono::steady_clock;

constexpr std::chrono::seconds kFirst{1};
constexpr std::chrono::seconds kBetween{2};

}  // namespace

ProgressReport progressLines(std::function<void(const std::string& line)> print)
{
  return [print = std::move(print), next = Clock::now() + kFirst](const char* task, double fraction) mutable
  {
    const Clock::time_point now = Clock::now();
    if (now < next)
      return;
    next = now + kBetween;
    const int percent = static_cast<int>(std::lround(100.0 * std::min(1.0, std::max(0.0, fraction))));
    print(std::string(task) + (percent > 0 ? ": " + std::to_string(percent) + " %" : ""));
  };
}

ProgressReport progressOnErrorStream()
{
  return progressLines([](const std::string& line) { std::cerr << "   " << line << std::endl; });
}

}  // namespace endovascular_sim
