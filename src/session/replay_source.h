#pragma once

#include <cstdint>

#include "contact/contact_set.h"

namespace endovascular_sim::session
{

/** A detector that fails where a recording says that contact sets came too late, so that the solver uses its old set at
 *  the very same passes. */
class ReplayContactSource : public contact::ContactSource
{
public:
  explicit ReplayContactSource(contact::ContactSource& detector) : detector_(detector) {}

  /** @param stale_passes bit p: pass p of the coming step gets no answer */
  void setStalePasses(std::uint64_t stale_passes) { stale_passes_ = stale_passes; }

  void detect(const contact::Query& query, contact::ContactSet& set) override
  {
    if (query.pass < 64 && (stale_passes_ >> query.pass & 1U) != 0)
      set.stale = true;
    else
      detector_.detect(query, set);
  }

private:
  contact::ContactSource& detector_;
  std::uint64_t stale_passes_ = 0;
};

}  // namespace endovascular_sim::session
