#include "procedure/support_watch.h"

#include <algorithm>
#include <cstddef>

namespace endovascular_sim::procedure
{

SupportWatch::SupportWatch(const scene::Scene& scene, const BranchLocator& locator, int entered)
  : limits_(scene.errors.value_or(scene::ErrorLimits()))
{
  for (int branch = 0; branch < locator.branches(); ++branch)
    way_.push_back(locator.pathBetween(entered, branch));
  for (std::size_t k = 0; k < scene.instruments.size(); ++k)
    if (scene.instruments[k].instrument.kind == instrument::Kind::kCatheter)
    {
      catheters_.emplace_back();
      catheters_.back().instrument = static_cast<int>(k);
    }
}

std::vector<int> SupportWatch::add(const Observation& observation)
{
  std::vector<int> losing;
  for (Catheter& catheter : catheters_)
    if (losesSupport(catheter, observation))
      losing.push_back(catheter.instrument);
  return losing;
}

/** True where the tip of an instrument is in a branch or beyond it. */
bool SupportWatch::isBeyond(int support, const InstrumentView& view) const
{
  const int branch = view.branch_position.branch;
  return branch >= 0 && way_[static_cast<std::size_t>(branch)][static_cast<std::size_t>(support)];
}

/** True where the tip of a catheter, or of an instrument ahead of it, is in the branch of its support or beyond. */
bool SupportWatch::isHeld(const Catheter& catheter, const Observation& observation) const
{
  const InstrumentView& view = observation.instruments[static_cast<std::size_t>(catheter.instrument)];
  const auto inner_end = observation.instruments.begin() + catheter.instrument;
  return isBeyond(catheter.support, view) ||
         std::any_of(observation.instruments.begin(), inner_end,
                     [&](const InstrumentView& inner)
                     { return inner.hand.insertion > view.hand.insertion && isBeyond(catheter.support, inner); });
}

bool SupportWatch::losesSupport(Catheter& catheter, const Observation& observation) const
{
  const InstrumentView& view = observation.instruments[static_cast<std::size_t>(catheter.instrument)];
  const double time = observation.time;
  const auto inner_end = observation.instruments.begin() + catheter.instrument;
  const bool guides =
      std::any_of(observation.instruments.begin(), inner_end,
                  [&](const InstrumentView& inner) { return inner.hand.insertion > view.hand.insertion; });
  const int branch = view.hand.insertion > 0.0 ? view.branch_position.branch : -1;
  if (branch != catheter.occupied)
  {
    catheter.occupied = branch;
    catheter.since = time;
  }
  const bool rests = branch >= 0 && time - catheter.since >= limits_.support_time;
  if (!guides)
    catheter.support = -1;
  if (catheter.support < 0 || (rests && branch != catheter.support && isBeyond(catheter.support, view)))
  {
    catheter.support = guides && rests ? branch : -1;
    catheter.inserted = view.hand.insertion;
    catheter.lost_since = -1.0;
    return false;
  }
  if (isHeld(catheter, observation))
  {
    catheter.inserted = std::max(catheter.inserted, view.hand.insertion);
    catheter.lost_since = -1.0;
    return false;
  }
  if (catheter.lost_since < 0.0)
    catheter.lost_since = time;
  if (time - catheter.lost_since < limits_.support_time)
    return false;
  catheter.support = -1;
  return catheter.inserted - view.hand.insertion < limits_.support_withdrawal;
}

}  // namespace endovascular_sim::procedure
