#pragma once

#include <array>
#include <chrono>
#include <cstddef>

namespace endovascular_sim
{

/** The parts of a step whose time is reported. A phase that a scene does not need stays at exactly zero. */
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

/** Time spent per phase since the last reset. It measures only: nothing that the simulation computes depends on it. */
class PhaseTimer
{
public:
  using Clock = std::chrono::steady_clock;

  void reset()
  {
    seconds_.fill(0.0);
    entries_.fill(0);
  }

  double seconds(Phase phase) const { return seconds_[static_cast<std::size_t>(phase)]; }

  /** How often a phase was entered since the last reset. */
  int entries(Phase phase) const { return entries_[static_cast<std::size_t>(phase)]; }

  /** Runs the phase from construction to destruction. */
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
