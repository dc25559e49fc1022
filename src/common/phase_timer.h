#pragma once

#include <array>
#include <chrono>
#include <cstddef>
#include <optional>

namespace endovascular_sim
{

/** Phases of a step with separately reported times. Together they cover the step. A phase that a scene does not use
 *  stays at exactly zero. */
enum class Phase
{
  kCollision,  ///< queries of the wall
  kAssembly,   ///< of the system of a solve
  kSolve,      ///< factorisations, and the choice of the active contacts
  kSampling,   ///< choice of the nodes
  kTwist,
  kContact,   ///< springs, permitted motion and limits of the contacts that a query found
  kFriction,  ///< of the wall
  kLayers,    ///< places of coaxial instruments, their loads on each other, and their friction
  kForces,    ///< at the hands and on the wall
  kBalloon,   ///< widths of balloons, and the motion of the wall
  kBlood,     ///< flow of blood, where it is computed here, and its loads
  kControl,   ///< all else: commands, grips, copies of the state
};
constexpr std::size_t kPhaseCount = 12;
constexpr std::array<const char*, kPhaseCount> kPhaseNames = {"collision", "assembly", "solve",    "sampling",
                                                              "twist",     "contact",  "friction", "layers",
                                                              "forces",    "balloon",  "blood",    "control"};

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

  /** Guard that counts the time from its construction to its destruction towards a phase, less that of guards inside.
   */
  class Scope
  {
  public:
    Scope(PhaseTimer& timer, Phase phase) : timer_(timer), outer_(timer.phase_)
    {
      ++timer_.entries_[static_cast<std::size_t>(phase)];
      timer_.enter(phase);
    }
    ~Scope() { timer_.enter(outer_); }
    Scope(const Scope&) = delete;
    Scope& operator=(const Scope&) = delete;

  private:
    PhaseTimer& timer_;
    std::optional<Phase> outer_;
  };

private:
  /** Ends the present phase. @param phase that begins; none: time is not counted */
  void enter(std::optional<Phase> phase)
  {
    const Clock::time_point now = Clock::now();
    if (phase_)
      seconds_[static_cast<std::size_t>(*phase_)] += std::chrono::duration<double>(now - since_).count();
    phase_ = phase;
    since_ = now;
  }

  std::optional<Phase> phase_;  ///< that is counted at present
  Clock::time_point since_;     ///< begin of the present phase, or of its part after the last guard inside
  std::array<double, kPhaseCount> seconds_{};
  std::array<int, kPhaseCount> entries_{};
};

}  // namespace endovascular_sim
