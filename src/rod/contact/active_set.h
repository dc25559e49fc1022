#pragma once

#include <cstddef>
#include <vector>

#include "rod/contact/contact_list.h"

namespace endovascular_sim::rod
{

/** Active-set search over one-sided springs.
 *
 *  The problem of a solve is convex and piecewise quadratic, and each solve is a Newton step on it. Full steps may
 *  cycle. Therefore a line search from the present iterate towards the solution minimises the energy. The springs
 *  compressed at the minimum become active. From the 12th pass on, springs are only activated, so the search ends;
 *  superfluous active springs then pull. */
class ActiveSet
{
public:
  /** Updates the active springs after a solve.
   *  @param pass number of solves of this problem before this one
   *  @param same_rest true if the system without the springs is that of the last solve; otherwise the search starts at
   *  the solution
   *  @return true if the problem must be solved again */
  bool update(ContactList& contacts, const NodalMotion& motion, int pass, bool same_rest);

  /** Lowest node of the springs changed by the last update that returned true; INT_MAX if it changed none. */
  int firstChanged() const { return first_changed_; }

private:
  double shareOfLeastEnergy(const std::vector<ContactSpring>& springs);

  int first_changed_ = 0;
  std::vector<double> gap_after_;       ///< gap of every spring after the motion of the last solve [m]
  std::vector<std::size_t> resisting_;  ///< springs considered by the line search
};

}  // namespace endovascular_sim::rod
