#pragma once

#include <array>
#include <chrono>
#include <cstddef>

#include "common/time/processor_time.h"

namespace endovascular_sim::nodes
{

/** Phases of a step in the graph. `simulation` is the step as `simulate` computes it, without contact detection. */
enum class LoopPhase
{
  kCommands,    ///< commands of topics, files and the scripted operator
  kSimulation,  ///< Simulation::stepAll without the next two
  kConversion,  ///< queries to bytes, bytes to contact sets, and their check
  kTransport,   ///< to the contact node and back; its wall time contains the detection
  kPublishing,  ///< messages of the step
  kRecording,   ///< forces on the wall and samples of the session
};
constexpr std::size_t kLoopPhases = 6;
constexpr std::array<const char*, kLoopPhases> kLoopPhaseNames = {"commands",  "simulation", "conversion",
                                                                  "transport", "publishing", "recording"};

/** Times of a step [s]. */
struct LoopTimes
{
  std::array<double, kLoopPhases> wall{};       ///< wall time of each phase
  std::array<double, kLoopPhases> processor{};  ///< processor time of the loop's thread in each phase
};

/** Costs of the loop by phase, of the last step. Used by one thread. */
class LoopCosts
{
public:
  /** Begins a step. */
  void begin() { last_ = LoopTimes(); }

  const LoopTimes& last() const { return last_; }

  /** Guard that counts the time from its construction to its destruction towards a phase. A scope within another one
   *  interrupts the outer phase. */
  class Scope
  {
  public:
    Scope(LoopCosts& costs, LoopPhase phase) : costs_(costs), outer_(costs.present_)
    {
      costs_.enter(static_cast<int>(phase));
    }
    ~Scope() { costs_.enter(outer_); }
    Scope(const Scope&) = delete;
    Scope& operator=(const Scope&) = delete;

  private:
    LoopCosts& costs_;
    int outer_;
  };

private:
  void enter(int phase)
  {
    const auto now = std::chrono::steady_clock::now();
    const double processor = processorSeconds();
    if (present_ >= 0)
    {
      const auto k = static_cast<std::size_t>(present_);
      last_.wall[k] += std::chrono::duration<double>(now - since_).count();
      last_.processor[k] += processor - processor_since_;
    }
    present_ = phase;
    since_ = now;
    processor_since_ = processor;
  }

  LoopTimes last_;
  int present_ = -1;  ///< phase; −1 between two
  std::chrono::steady_clock::time_point since_;
  double processor_since_ = 0.0;  ///< [s]
};

}  // namespace endovascular_sim::nodes
