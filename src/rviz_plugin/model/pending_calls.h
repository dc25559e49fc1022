#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "rviz_plugin/model/session_port.h"

namespace endovascular_sim::rviz_plugin
{

/** Outcome of a service call. */
struct CallOutcome
{
  bool is_success = false;
  std::string text;
};

/** Service calls of the panel, each in a thread of its own. No call waits for another one, and nobody for a call: a
 *  service that does not respond blocks neither the window nor a pause. */
class PendingCalls
{
public:
  /** Begins a call.
   *  @param name of the service, for waiting()
   *  @param call may block for any time, also beyond the life of this object
   *  @return false for a request that waits already; Start and Pause are repeated up to kMostRepeated times */
  bool begin(Request request, const std::string& name, const std::function<CallOutcome()>& call);

  /** Services that have not answered yet, oldest first, with the time since the call. */
  std::vector<std::string> waiting() const;

  /** Text of the last answer; empty from the begin of a call. */
  std::string answer() const;

private:
  static constexpr int kMostRepeated = 5;

  struct Data;
  std::shared_ptr<Data> data_ = makeData();
  static std::shared_ptr<Data> makeData();
};

}  // namespace endovascular_sim::rviz_plugin
