#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string>

#include "endovascular_sim/PlayerControl.h"

namespace endovascular_sim::rviz_plugin
{

/** Commands of the panel to the player of a recording, called in a thread of its own. While a call waits, a seek
 * replaces the seek before it: a slider that is dragged does not lag behind. No function blocks. */
class PlayerRemote
{
public:
  /** Calls the service with a request. @return reason of a failure; empty without one */
  using Call = std::function<std::string(const PlayerControl::Request&)>;

  /** @param call may block for any time, also beyond the life of this object */
  explicit PlayerRemote(Call call);
  ~PlayerRemote();
  PlayerRemote(const PlayerRemote&) = delete;
  PlayerRemote& operator=(const PlayerRemote&) = delete;

  /** Gives a command of PlayerControl, after those before it. */
  void give(std::uint8_t command, double value);

  /** Reason of the last failure; empty after a success. */
  std::string answer() const;

private:
  struct Data;

  static void loop(const std::shared_ptr<Data>& data);

  std::shared_ptr<Data> data_;
};

}  // namespace endovascular_sim::rviz_plugin
