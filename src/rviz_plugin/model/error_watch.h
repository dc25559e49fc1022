#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "endovascular_sim/ProcedureStep.h"
#include "endovascular_sim/SessionProgress.h"

namespace endovascular_sim::rviz_plugin
{

/** Watch of the trainee's errors: names each one when it happens. */
class ErrorWatch
{
public:
  /** Takes over a step: wrong branches, a loss of the support, a failure.
   *  @param branch that holds the foremost tip; empty: unknown
   *  @return the new error; empty without one */
  std::string follow(const ProcedureStep& step, const std::string& branch);

  /** Takes over the errors of the recording's metrics. @return as above */
  std::string follow(const SessionProgress& progress);

  /** True if the newest error is a wrong branch that the tip has left, or whose step is done.
   *  @param branch as above */
  bool isOver(const std::string& branch) const;

private:
  std::optional<std::string> wrong_branch_;  ///< name of it, if the newest error is one; empty: unknown
  std::uint32_t begun_ = 0, wrong_branches_ = 0, run_ = 0, errors_ = 0;
  std::uint8_t outcome_ = ProcedureStep::RUNNING;
};

}  // namespace endovascular_sim::rviz_plugin
