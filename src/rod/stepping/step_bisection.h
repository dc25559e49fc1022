#pragma once

#include <cstddef>
#include <vector>

#include "rod/stepping/stepper.h"

namespace endovascular_sim::rod
{

/** Input of the first half of a step that begins at @p state and ends at @p input. */
StepInput firstHalf(const State& state, const StepInput& input);

/** Input of the second half. @param half input of the first one */
StepInput secondHalf(const StepInput& half, const StepInput& input);

/** Bisection of time steps: a step that cannot be solved is divided into two halves, at most kMaxDepth times. */
class StepBisection
{
public:
  static constexpr int kMaxDepth = 3;

  /** Advances the state by @p dt [s]. When even the shortest part has no solution, the state returns to the beginning
   *  of the step, at rest.
   *  @param solve (State& state, const State& before, const StepInput& input, double dt, bool shortest) → bool, false
   *         where the part is rejected; @c shortest is set for parts that are not divided further
   *  @param reset () → void, called after the state has returned to the beginning of a part
   *  @return false when the step has no solution */
  template <typename Solve, typename Reset>
  bool advance(State& state, const StepInput& input, double dt, StepReport& report, const Solve& solve,
               const Reset& reset)
  {
    return advancePart(state, input, dt, 0, report, solve, reset);
  }

private:
  template <typename Solve, typename Reset>
  bool advancePart(State& state, const StepInput& input, double dt, int depth, StepReport& report, const Solve& solve,
                   const Reset& reset);

  std::vector<State> before_;  ///< state at the beginning of a part, per depth
};

template <typename Solve, typename Reset>
bool StepBisection::advancePart(State& state, const StepInput& input, double dt, int depth, StepReport& report,
                                const Solve& solve, const Reset& reset)
{
  const auto level = static_cast<std::size_t>(depth);
  if (before_.size() <= level)
    before_.resize(level + 1);
  before_[level] = state;
  if (solve(state, before_[level], input, dt, depth == kMaxDepth))
    return true;
  state = before_[level];
  reset();
  if (depth < kMaxDepth)
  {
    ++report.bisections;
    const StepInput half = firstHalf(state, input);
    if (advancePart(state, half, 0.5 * dt, depth + 1, report, solve, reset) &&
        advancePart(state, secondHalf(half, input), 0.5 * dt, depth + 1, report, solve, reset))
      return true;
    state = before_[level];
    reset();
  }
  for (Eigen::Vector3d& velocity : state.velocity)
    velocity.setZero();
  return false;
}

}  // namespace endovascular_sim::rod
