#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace endovascular_sim::rviz_plugin
{

/** State of a gamepad. Axes are from −1 to 1, with a dead zone around 0. */
struct JoystickState
{
  double push = 0.0;   ///< left stick forwards: positive
  double twist = 0.0;  ///< right stick, or left stick, to the right: positive
  bool is_connected = false;
  std::vector<int> pressed;  ///< buttons that were pressed since the last call
};

/** Gamepad or joystick of the Linux joystick interface (linux/joystick.h), read without blocking.
 *
 *  A device that is missing or unplugged is looked for again every two seconds. Without a device, and after a read
 * error, both axes are 0. */
class Joystick
{
public:
  /** @param device path of the device; a pipe in tests */
  explicit Joystick(std::string device = "/dev/input/js0");
  ~Joystick();
  Joystick(const Joystick&) = delete;
  Joystick& operator=(const Joystick&) = delete;

  /** Takes over all events so far.
   *  @param time of a steady clock [s] */
  const JoystickState& poll(double time);

private:
  void connect(double time);
  void disconnect();
  void takeOver(std::uint8_t type, std::uint8_t number, std::int16_t value);

  std::string device_;
  int file_ = -1;
  double tried_ = -1e9;  ///< time of the last search [s]
  double left_x_ = 0.0, left_y_ = 0.0, right_x_ = 0.0;
  JoystickState state_;
};

}  // namespace endovascular_sim::rviz_plugin
