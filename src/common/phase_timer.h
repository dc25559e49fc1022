#pragma once

#include <array>
#include <chrono>
#include <cstddef>

namespace endovascular_sim
{

/** Phases of a step with separately reported times. A phase that a scene does not use stays at exactly zero. */
enum class Phase
{
  kCollision,
  kAssembly,
  kSolve,
  kSampling,
  kTwist,
};
constexpr std::size_t kPhaseCount = 5;
constexpr std::array<const char*, kPhaseCount> kPhaseNames = {"collision", "assembly", "solve", "sampling", "twist"};

/** Time spent per phase since the last reset. No result of the simulation depends on it. */
class PhaseTimer
{
public:
  using Clock = std::chrono::steady_clock;

  void reset()
  {
    seconds_.fill(0.0);
    entries_.fill(0);
  }

  /** Time spent in a phase since the last reset [s]. */
  double seconds(Phase phase) const { return seconds_[static_cast<std::size_t>(phase)]; }

  /** Number of entries into a phase since the last reset. */
  int entries(Phase phase) const { return entries_[static_cast<std::size_t>(phase)]; }

  /** Guard that counts the time from its construction to its destruction towards a phase. */
  class Scope
  {
  public:
    Scope(PhaseTimer& timer, Phase phase) : timer_(timer), phase_(phase), begin_(Clock::now())
    {
      ++timer_.entries_[static_cast<std::size_t>(phase_)];
    }
    ~Scope()
    {
      timer_.seconds_[static_cast<std::size_t>(phase_)] += std::chrono::duration<double>(Clock::now() - begin_).count();
    }
    Scope(const Scope&) = delete;
    Scope& operator=(const Scope&) = delete;

  private:
    PhaseTimer& timer_;
    Phase phase_;
    Clock::time_point begin_;
  };

private:
  std::array<double, kPhaseCount> seconds_{};
  std::array<int, kPhaseCount> entries_{};
};

}  // namespace endovascular_sim
