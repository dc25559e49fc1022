#pragma once

#include <cstdint>

#include "contact/contract/contact_set.h"

namespace endovascular_sim::simulation
{

/** A detector that fails where a recording says that contact sets came too late, so that the solver uses its old set at
 *  the very same passes. */
class ReplayContactSource : public contact::ContactSource
{
public:
  explicit ReplayContactSource(contact::ContactSource& detector) : detector_(detector) {}

  /** @param pass from this pass on the coming step gets no answers; contact::kNoStalePass: it gets all */
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
