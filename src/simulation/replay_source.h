#pragma once

#include <cstdint>

#include "contact/contract/contact_set.h"

namespace endovascular_sim::simulation
{

/** Contact source that reports stale sets at the passes at which contact sets came too late in a recording. */
class ReplayContactSource : public contact::ContactSource
{
public:
  explicit ReplayContactSource(contact::ContactSource& detector) : detector_(detector) {}

  /** @param pass first pass of the coming step without a fresh set; contact::kNoStalePass: none */
  void setFirstStalePass(std::uint32_t pass) { first_stale_pass_ = pass; }

  void detect(const contact::Query& query, contact::ContactSet& set) override
  {
    if (query.pass >= first_stale_pass_)
      set.stale = true;
    else
      detector_.detect(query, set);
  }

  void freeDistances(const contact::Query& query, double wanted, contact::ContactSet& set) override
  {
    if (query.pass >= first_stale_pass_)
      set.stale = true;
    else
      detector_.freeDistances(query, wanted, set);
  }

private:
  contact::ContactSource& detector_;
  std::uint32_t first_stale_pass_ = contact::kNoStalePass;
};

}  // namespace endovascular_sim::simulation
