#pragma once

#include <cstddef>
#include <functional>
#include <map>
#include <string>

#include "procedure/operator.h"

namespace endovascular_sim::session
{

/** States at the beginnings of the steps of a procedure, from which a person can repeat them. */
class StepStates
{
public:
  /** Keeps a state if a step has begun since the last call. To be called after every step of the simulation.
   *  @param save present state of the session
   *  @return true if a state was kept */
  bool follow(const procedure::Operator& observer, const std::function<std::string()>& save);

  /** Step that runs, from 0, an exchange counted as two. */
  std::size_t present() const { return present_; }

  /** State at the newest beginning of a step; null before it.
   *  @param step from 0 */
  const std::string* at(std::size_t step) const;

private:
  std::map<std::size_t, std::string> states_;
  std::size_t begun_ = 0;  ///< number of beginnings at the last call
  std::size_t present_ = 0;
};

}  // namespace endovascular_sim::session
