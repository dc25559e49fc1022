#include <poll.h>
#include <sched.h>
#include <sys/prctl.h>
#include <termios.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <csignal>
#include <cstdio>
#include <ctime>
#include <exception>
#include <fstream>
#include <iostream>
#include <limits>
#include <memory>
#include <string>
#include <vector>

#include <ros/init.h>
#include <nlohmann/json.hpp>

#include "common/error.h"
#include "haptics/device/device_simulator.h"
#include "haptics/device/motion_script.h"
#include "haptics/serial/serial_port.h"
#include "nodes/haptic_device/haptic_topics.h"
#include "nodes/runtime/real_time.h"
#include "scene/model/scene.h"
#include "scene/scene_file.h"

namespace
{

using endovascular_sim::InputError;
using endovascular_sim::haptics::DeviceSimulator;
using endovascular_sim::haptics::HandMotion;
using endovascular_sim::haptics::HapticSample;
using endovascular_sim::haptics::MotionScript;
using endovascular_sim::haptics::PayloadFormat;
using endovascular_sim::haptics::SimulatorOptions;
using endovascular_sim::haptics::StartCondition;

constexpr auto kUsage = R"(Plays a haptic device on a pseudo-terminal: real rosserial bytes at the speed of a real line.

usage: device_simulator --link PATH (--scene FILE | --script FILE | --keyboard) [options]

  --link PATH          name under which the host finds the device; a link is made there
  --scene FILE         the operator plays the scene's drive profile
  --set key.path=value replaces a value of the scene; may be repeated
  --script FILE        the operator plays a CSV file: time [s], insertion [m], rotation [rad]
  --keyboard           arrow keys: up push, down pull, left and right twist; space grip, q end
  --start WHEN         the motion begins when the host has subscribed (subscribed, the default) or when the
                       simulation's forces come back (enabled)
  --seconds T          ends T seconds after the motion began; default: runs until stopped
  --rate HZ            samples per second, default 1000
  --baud N             speed of the line, default 230400 [bit/s]
  --sample KIND        haptic (13 bytes, default) or joint_state (with a Wrench for the force; about 100 bytes)
  --unplug-at T        pulls the plug T seconds after the motion began
  --replug-after T     and puts it back T seconds later, restarted; default: never
  --out FILE           writes what was measured as JSON
  --help               prints this

exit code: 0 ended as asked or by a signal, 1 refused (the reason goes to the error stream), 2 wrong use
)";

volatile std::sig_atomic_t stop_requested = 0;

void requestStop(int /*signal*/)
{
  stop_requested = 1;
}

struct Arguments
{
  std::string link;
  std::string scene;
  std::vector<std::string> overrides;
  std::string script;
  bool keyboard = false;
  std::string start = "subscribed";
  double seconds = std::numeric_limits<double>::infinity();
  double rate = 1000.0;
  int baud = 230400;
  std::string sample = "haptic";
  double unplug_at = std::numeric_limits<double>::infinity();
  double replug_after = std::numeric_limits<double>::infinity();
  std::string out;
  bool help = false;
};

double number(const std::string& option, const std::string& text)
{
  std::size_t used = 0;
  double value = std::numeric_limits<double>::quiet_NaN();
  try
  {
    value = std::stod(text, &used);
  }
  catch (const std::exception&)
  {
    used = 0;
  }
  if (used != text.size() || !(value >= 0.0))
    throw InputError("command line", option, "needs a number that is not negative, not \"" + text + "\"");
  return value;
}

Arguments parse(const std::vector<std::string>& words)
{
  Arguments arguments;
  for (std::size_t i = 0; i < words.size(); ++i)
  {
    const std::string& option = words[i];
    const auto value = [&]() -> const std::string&
    {
      if (i + 1 >= words.size())
        throw InputError("command line", option, "needs a value");
      return words[++i];
    };
    if (option == "--help" || option == "-h")
      arguments.help = true;
    else if (option == "--keyboard")
      arguments.keyboard = true;
    else if (option == "--link")
      arguments.link = value();
    else if (option == "--scene")
      arguments.scene = value();
    else if (option == "--set")
      arguments.overrides.push_back(value());
    else if (option == "--script")
      arguments.script = value();
    else if (option == "--start")
      arguments.start = value();
    else if (option == "--sample")
      arguments.sample = value();
    else if (option == "--out")
      arguments.out = value();
    else if (option == "--seconds")
      arguments.seconds = number(option, value());
    else if (option == "--rate")
      arguments.rate = number(option, value());
    else if (option == "--baud")
      arguments.baud = static_cast<int>(number(option, value()));
    else if (option == "--unplug-at")
      arguments.unplug_at = number(option, value());
    else if (option == "--replug-after")
      arguments.replug_after = number(option, value());
    else
      throw InputError("command line", option, "is not an option; --help lists them");
  }
  return arguments;
}

void check(const Arguments& arguments)
{
  if (arguments.link.empty())
    throw InputError("command line", "--link", "is missing; give the path under which the host shall find the device");
  const int sources = int{!arguments.scene.empty()} + int{!arguments.script.empty()} + int{arguments.keyboard};
  if (sources != 1)
    throw InputError("command line", "", "give exactly one of --scene, --script and --keyboard");
  if (arguments.start != "subscribed" && arguments.start != "enabled")
    throw InputError("command line", "--start", "is subscribed or enabled, not " + arguments.start);
  if (arguments.sample != "haptic" && arguments.sample != "joint_state")
    throw InputError("command line", "--sample", "is haptic or joint_state, not " + arguments.sample);
  if (arguments.rate < 1.0 || arguments.rate > 10000.0)
    throw InputError("command line", "--rate", "must lie between 1 and 10000 Hz");
  endovascular_sim::haptics::SerialPort::checkBaud(arguments.baud, "--baud");
}

/** A hand that is led by keys: each press moves the goal, the hand follows at a human speed. */
class KeyboardOperator
{
public:
  KeyboardOperator()
  {
    tcgetattr(STDIN_FILENO, &saved_);
    termios raw = saved_;
    raw.c_lflag &= ~static_cast<tcflag_t>(ICANON | ECHO);
    raw.c_cc[VMIN] = 0;
    raw.c_cc[VTIME] = 0;
    tcsetattr(STDIN_FILENO, TCSANOW, &raw);
    std::printf("up push, down pull, left/right twist, space grip on/off, q end\n");
  }
  ~KeyboardOperator()
  {
    tcsetattr(STDIN_FILENO, TCSANOW, &saved_);
    std::printf("\n");
  }
  KeyboardOperator(const KeyboardOperator&) = delete;
  KeyboardOperator& operator=(const KeyboardOperator&) = delete;

  void readKeys()
  {
    char keys[64];
    const ssize_t count = read(STDIN_FILENO, keys, sizeof keys);
    for (ssize_t i = 0; i < count; ++i)
    {
      if (keys[i] == 'q')
        stop_requested = 1;
      else if (keys[i] == ' ')
        grips_ = !grips_;
      else if (keys[i] == '\x1b' && i + 2 < count)
      {
        press(keys[i + 2]);
        i += 2;
      }
    }
  }

  HandMotion at(double time)
  {
    constexpr double speed = 50e-3;        // [m/s]
    constexpr double turning_speed = 6.0;  // [rad/s]
    const double step = std::clamp(time - time_, 0.0, 0.02);
    time_ = time;
    hand_.insertion += std::clamp(goal_.insertion - hand_.insertion, -speed * step, speed * step);
    hand_.rotation += std::clamp(goal_.rotation - hand_.rotation, -turning_speed * step, turning_speed * step);
    return hand_;
  }

  bool grips() const { return grips_; }

private:
  void press(char arrow)
  {
    constexpr double push = 2e-3;  // per key [m]
    constexpr double twist = 0.1;  // per key [rad]
    goal_.insertion += arrow == 'A' ? push : arrow == 'B' ? -push : 0.0;
    goal_.rotation += arrow == 'C' ? twist : arrow == 'D' ? -twist : 0.0;
  }

  termios saved_ = {};
  HandMotion goal_;
  HandMotion hand_;
  double time_ = 0.0;
  bool grips_ = true;
};

double steadyNow()
{
  timespec time = {};
  clock_gettime(CLOCK_MONOTONIC, &time);
  return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
}

SimulatorOptions simulatorOptions(const Arguments& arguments, KeyboardOperator* keyboard)
{
  SimulatorOptions options;
  options.link = arguments.link;
  options.baud = arguments.baud;
  options.rate = arguments.rate;
  options.start = arguments.start == "enabled" ? StartCondition::kEnabled : StartCondition::kSubscribed;
  options.duration = std::numeric_limits<double>::infinity();
  using endovascular_sim::nodes::topicType;
  if (arguments.sample == "haptic")
  {
    options.device.sample = topicType<endovascular_sim::HapticSample>(PayloadFormat::kHapticSample);
    options.device.force = topicType<endovascular_sim::HapticForce>(PayloadFormat::kHapticForce);
  }
  else
  {
    options.device.sample = topicType<sensor_msgs::JointState>(PayloadFormat::kJointState);
    options.device.force = topicType<geometry_msgs::Wrench>(PayloadFormat::kWrench);
  }
  if (keyboard != nullptr)
  {
    options.motion = [keyboard](double time) { return keyboard->at(time); };
  }
  else if (!arguments.script.empty())
  {
    const MotionScript script = MotionScript::load(arguments.script);
    options.motion = [script](double time) { return script.at(time); };
    options.duration = script.duration();
  }
  else
  {
    const auto scene = endovascular_sim::scene::loadScene(arguments.scene, arguments.overrides);
    const auto drive = scene.instruments.front().drive;
    options.duration = scene.duration;
    // The device counts from where it starts; where the wire starts is the scene's and the host's business.
    options.motion = [drive](double time) -> HandMotion {
      return {drive.insertionAt(time) - drive.initial_insertion, drive.rotationAt(time) - drive.initial_rotation};
    };
  }
  return options;
}

void writeReport(const DeviceSimulator::Report& report, const std::string& file)
{
  const auto statistics = [](const endovascular_sim::haptics::LatencyRecord& record) -> nlohmann::ordered_json
  {
    return {{"count", record.count()},
            {"median", 1e3 * record.percentile(0.5)},
            {"p99", 1e3 * record.percentile(0.99)},
            {"max", 1e3 * record.percentile(1.0)}};
  };
  const nlohmann::ordered_json json = {{"latency_ms", statistics(report.latency)},
                                       {"motion_to_force_ms", statistics(report.motion_to_force)},
                                       {"samples", report.samples},
                                       {"samples_skipped", report.samples_skipped},
                                       {"forces", report.forces},
                                       {"forces_enabled", report.enabled_forces},
                                       {"force_rate_hz", report.forceRate()},
                                       {"force_max_n", report.largest_force},
                                       {"torque_max_nm", report.largest_torque},
                                       {"watchdog_trips", report.watchdog_trips},
                                       {"stops", report.stops},
                                       {"bytes_lost", report.bytes_lost},
                                       {"resyncs", report.resyncs},
                                       {"unplugged", report.unplugged}};
  std::cout << json.dump(2) << "\n";
  if (file.empty())
    return;
  std::ofstream stream(file);
  stream << json.dump(2) << "\n";
  if (!stream.flush())
    throw InputError(file, "", "cannot be written; choose a folder that exists and can be written");
}

void showHand(const DeviceSimulator& device)
{
  static const char* const states[] = {"disabled", "enabled ", "paused  ", "fault   "};
  const auto& force = device.shown();
  std::printf("\rinsertion %8.2f mm  rotation %7.2f rad  force %7.3f N  torque %8.5f N m  %s ",
              1e3 * device.hand().insertion, device.hand().rotation, static_cast<double>(force.force),
              static_cast<double>(force.torque), states[static_cast<int>(force.state)]);
  std::fflush(stdout);
}

void waitUntil(double wake, int descriptor)
{
  const double wait = std::clamp(wake - steadyNow(), 0.0, 0.02);
  timespec timeout = {};
  timeout.tv_nsec = static_cast<long>(wait * 1e9);
  pollfd source = {descriptor, POLLIN, 0};
  ppoll(&source, 1, &timeout, nullptr);
}

/** Pulls the plug and puts it back when it is time. */
void movePlug(DeviceSimulator& device, const Arguments& arguments, double now)
{
  const double time = device.motionTime(now);
  const bool out =
      device.hasStarted() && time >= arguments.unplug_at && time < arguments.unplug_at + arguments.replug_after;
  if (out && device.isPlugged())
    device.unplug();
  else if (!out && !device.isPlugged())
    device.plug(now);
}

void run(const Arguments& arguments)
{
  const auto keyboard = arguments.keyboard ? std::make_unique<KeyboardOperator>() : nullptr;
  DeviceSimulator device(simulatorOptions(arguments, keyboard.get()));
  // A device does not share its processor with the simulation: ask to be served first.
  prctl(PR_SET_TIMERSLACK, 1UL);
  sched_param priority = {};
  priority.sched_priority = sched_get_priority_min(SCHED_FIFO);
  sched_setscheduler(0, SCHED_FIFO, &priority);
  device.plug(steadyNow());
  double shown_at = 0.0;
  while (stop_requested == 0)
  {
    const double now = steadyNow();
    if (device.motionTime(now) >= arguments.seconds)
      break;
    if (keyboard)
    {
      keyboard->readKeys();
      device.setFlags(keyboard->grips() ? HapticSample::kEnabled : 0);
      if (now - shown_at >= 0.1)
      {
        showHand(device);
        shown_at = now;
      }
    }
    movePlug(device, arguments, now);
    device.step(now);
    waitUntil(device.isPlugged() ? device.wakeAt() : now + 5e-3, device.descriptor());
  }
  device.unplug();
  writeReport(device.report(), arguments.out);
}

}  // namespace

int main(int argc, char** argv)
{
  endovascular_sim::nodes::avoidLockStepProcessor();
  Arguments arguments;
  try
  {
    std::vector<std::string> words;
    ros::removeROSArgs(argc, argv, words);  // roslaunch appends its own
    arguments = parse({words.begin() + 1, words.end()});
    if (arguments.help)
    {
      std::cout << kUsage;
      return 0;
    }
    check(arguments);
  }
  catch (const std::exception& error)
  {
    std::cerr << "device_simulator: " << error.what() << "\n" << kUsage;
    return 2;
  }
  std::signal(SIGINT, requestStop);
  std::signal(SIGTERM, requestStop);
  try
  {
    run(arguments);
  }
  catch (const std::exception& error)
  {
    std::cerr << "device_simulator: " << error.what() << "\n";
    return 1;
  }
  return 0;
}
