#pragma once

#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <functional>
#include <mutex>
#include <string>
#include <thread>

namespace endovascular_sim::rviz_plugin
{

/** Velocity of one instrument. */
struct HandVelocity
{
  std::string instrument;
  double insertion = 0.0;  ///< [m/s]
  double rotation = 0.0;   ///< [rad/s]

  bool isZero() const { return insertion == 0.0 && rotation == 0.0; }
};

/** Sends velocities at a constant rate from a thread of its own, however slowly a GUI draws.
 *
 *  A velocity is sent while it is held. A zero velocity is sent once, then nothing, so that another client may drive.
 *  Dead-man time-out: the motion ends when the GUI confirms it no longer, for example because it is frozen. A new
 * motion then begins only after a release. */
class VelocityCommander
{
public:
  using Send = std::function<void(const HandVelocity&)>;

  /** @param send called from the thread; its exceptions are dropped */
  explicit VelocityCommander(Send send, std::chrono::milliseconds period = std::chrono::milliseconds(10),
                             std::chrono::milliseconds dead_man = std::chrono::milliseconds(1500));
  ~VelocityCommander();
  VelocityCommander(const VelocityCommander&) = delete;
  VelocityCommander& operator=(const VelocityCommander&) = delete;

  /** Holds a velocity; a zero one releases. Confirms the motion. */
  void hold(const HandVelocity& velocity);

  /** Confirms that the GUI is at work. */
  void confirm();

  bool isMoving() const;
  std::uint64_t timeOuts() const;  ///< number of motions that the dead-man time-out has ended

private:
  void run();

  Send send_;
  const std::chrono::milliseconds period_, dead_man_;
  mutable std::mutex mutex_;
  std::condition_variable changed_;
  HandVelocity wanted_;
  std::string moving_;  ///< instrument that moves; empty: none
  std::chrono::steady_clock::time_point confirmed_;
  bool is_blocked_ = false;  ///< after a time-out, until a release
  bool is_ending_ = false;
  std::uint64_t time_outs_ = 0;
  std::thread thread_;  ///< last: it uses all other members
};

}  // namespace endovascular_sim::rviz_plugin
