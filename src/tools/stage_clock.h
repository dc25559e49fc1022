#pragma once

#include <chrono>
#include <cstdio>
#include <string>

namespace endovascular_sim::tools
{

/** Times of the stages on the error stream. */
class StageClock
{
public:
  explicit StageClock(bool quiet) : quiet_(quiet) {}

  void begin(const std::string& stage) const
  {
    if (!quiet_)
      std::fprintf(stderr, "%6.1f s  %s\n",
                   std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count(), stage.c_str());
  }

private:
  bool quiet_;
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

}  // namespace endovascular_sim::tools
