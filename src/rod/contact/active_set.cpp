#include "rod/contact/active_set.h"

#include <algorithm>
#include <limits>

namespace endovascular_sim::rod
{
namespace
{

constexpr int kOnlyAddFromPass = 12;
constexpr int kLineSearchBisections = 10;

}  // namespace

bool ActiveSet::update(ContactList& contacts, const NodalMotion& motion, int pass, bool same_rest)
{
  std::vector<ContactSpring>& springs = contacts.springs;
  const bool only_add = pass >= kOnlyAddFromPass;
  bool changed = false;
  gap_after_.resize(springs.size());
  for (std::size_t c = 0; c < springs.size(); ++c)
  {
    gap_after_[c] = springs[c].gapAfter(contacts.set.features[c].normal, motion);
    const bool active = gap_after_[c] < 0.0;
    changed |= active != springs[c].active && (active || !only_add);
  }
  if (!changed)
    return false;
  const double share = same_rest && !only_add ? shareOfLeastEnergy(springs) : 1.0;
  first_changed_ = std::numeric_limits<int>::max();
  for (std::size_t c = 0; c < springs.size(); ++c)
  {
    ContactSpring& spring = springs[c];
    const double gap = gap_after_[c];
    const double resisted = spring.active ? spring.stiffness * gap : 0.0;
    spring.reached += share * (gap - spring.reached);
    spring.resisted += share * (resisted - spring.resisted);
    const bool active = spring.reached < 0.0 || (only_add && spring.active);
    if (active != spring.active)
      first_changed_ = std::min(first_changed_, spring.node);
    spring.active = active;
  }
  return true;
}

/** Bisects the derivative of the energy along the line. The part of the springs is piecewise linear. The part of the
 *  system without springs is linear: at both ends it balances the active springs of the systems solved. */
double ActiveSet::shareOfLeastEnergy(const std::vector<ContactSpring>& springs)
{
  resisting_.clear();  // springs outside this list are open on the whole line
  for (std::size_t c = 0; c < springs.size(); ++c)
    if (springs[c].active || springs[c].resisted != 0.0 || springs[c].reached < 0.0 || gap_after_[c] < 0.0)
      resisting_.push_back(c);
  double low = 0.0;
  double high = 1.0;
  for (int k = 0; k <= kLineSearchBisections; ++k)
  {
    const double share = k == 0 ? 1.0 : 0.5 * (low + high);
    double slope = 0.0;
    for (const std::size_t c : resisting_)
    {
      const ContactSpring& spring = springs[c];
      const double gap = gap_after_[c];
      const double change = gap - spring.reached;
      const double rest = (1.0 - share) * spring.resisted + (spring.active ? share * spring.stiffness * gap : 0.0);
      slope += change * (spring.stiffness * std::min(0.0, spring.reached + share * change) - rest);
    }
    if (k == 0 && slope <= 0.0)
      return 1.0;
    (slope < 0.0 ? low : high) = share;
  }
  return high;  // just beyond the first spring that changes
}

}  // namespace endovascular_sim::rod
