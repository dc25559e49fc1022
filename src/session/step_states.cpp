#include "session/step_states.h"

namespace endovascular_sim::session
{

bool StepStates::follow(const procedure::Operator& observer, const std::function<std::string()>& save)
{
  if (observer.records().size() == begun_)
    return false;
  begun_ = observer.records().size();
  if (begun_ == 0)
    return false;
  present_ = observer.records().back().step;
  states_[present_] = save();
  return true;
}

const std::string* StepStates::at(std::size_t step) const
{
  const auto state = states_.find(step);
  return state == states_.end() ? nullptr : &state->second;
}

}  // namespace endovascular_sim::session
