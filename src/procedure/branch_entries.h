#pragma once

#include <vector>

#include "procedure/branch_locator.h"
#include "procedure/observation.h"
#include "scene/model/scene.h"

namespace endovascular_sim
{
class Archive;
}

namespace endovascular_sim::procedure
{

/** Index of an instrument of the scene by its name; −1 if there is none. */
int instrumentOf(const scene::Scene& scene, const std::string& name);

/** Steps of a procedure, with each exchange split into a withdrawal and an insertion. */
std::vector<scene::StepScene> expandedSteps(const scene::ProcedureScene& procedure);

/** Entries of tips into wrong branches: the one definition for the operator, the metrics and the marks of a lesson.
 *
 *  While a step advances an instrument to a branch, the branches off the path from the introducer to this goal are
 *  wrong for the instrument, unless the step has `any_branch`. At all other times, and for all other instruments,
 *  branches are wrong that lie on the path to none of the instrument's goals in the procedure. An instrument without a
 *  goal has no wrong branch. A tip enters at a depth of kDepth; it enters once until it has left the branch, and a
 *  branch that it has entered while this was right does not count later. */
class BranchEntries
{
public:
  static constexpr double kDepth = 3e-3;  ///< depth beyond the ostium at which a tip has entered a branch [m]

  /** @param entered branch that contains the introducer */
  BranchEntries(const scene::Scene& scene, const BranchLocator& locator, int entered);

  /** Adds an observation with the branches of the tips.
   *  @param step index in expandedSteps(); others: between the steps */
  void add(const Observation& observation, int step);

  /** True if the tip of an instrument entered a wrong branch at the last observation. */
  bool enters(int instrument) const { return tips_[static_cast<std::size_t>(instrument)].enters; }
  /** True from the entry of a wrong branch until the tip leaves the branch, or the branch becomes right. */
  bool isInside(int instrument) const { return tips_[static_cast<std::size_t>(instrument)].inside; }
  /** Number of instruments that entered a wrong branch at the last observation. */
  int entries() const;

  /** Saves or loads the mutable state. */
  void archive(Archive& archive);

private:
  struct Tip
  {
    int occupied = -1;  ///< branch that the tip has entered; −1: none
    bool inside = false;
    bool enters = false;
  };

  const std::vector<bool>& permitted(std::size_t instrument, int step) const;

  std::vector<std::vector<bool>> of_instrument_;  ///< for each instrument and branch: true if it leads to any goal
  std::vector<std::vector<bool>> of_step_;        ///< for each step and branch: true if it leads to the step's goal
  std::vector<int> moved_;  ///< for each step: instrument that it advances to a branch; −1: none
  std::vector<Tip> tips_;
};

}  // namespace endovascular_sim::procedure
