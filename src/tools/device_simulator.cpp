#include <poll.h>
#include <sched.h>
#include <sys/prctl.h>
#include <termios.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <fstream>
#include <iostream>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <ros/init.h>
#include <nlohmann/json.hpp>

#include "common/error.h"
#include "common/output_file.h"
#include "common/quantities.h"
#include "common/text/format.h"
#include "haptics/device/device_simulator.h"
#include "haptics/device/motion_script.h"
#include "haptics/serial/serial_port.h"
#include "nodes/haptic_device/haptic_topics.h"
#include "nodes/runtime/processor/processor_claim.h"
#include "nodes/runtime/real_time.h"
#include "scene/model/scene.h"
#include "scene/scene_file.h"
#include "tools/command_line.h"
#include "tools/tool_output.h"

namespace
{

using endovascular_sim::formatted;
using endovascular_sim::InputError;
using endovascular_sim::haptics::DeviceSimulator;
using endovascular_sim::haptics::HandMotion;
using endovascular_sim::haptics::HapticSample;
using endovascular_sim::haptics::MotionScript;
using endovascular_sim::haptics::PayloadFormat;
using endovascular_sim::haptics::SimulatorOptions;
using endovascular_sim::haptics::StartCondition;
using endovascular_sim::tools::CommandLine;

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
  std::string trace;
};

/** @return message for a rejected combination of arguments, or an empty text */
std::string conflict(const Arguments& arguments)
{
  const int sources = int{!arguments.scene.empty()} + int{!arguments.script.empty()} + int{arguments.keyboard};
  if (sources != 1)
    return "give exactly one of --scene, --script and --keyboard";
  try
  {
    endovascular_sim::haptics::SerialPort::checkBaud(arguments.baud, "--baud");
  }
  catch (const InputError& error)
  {
    return error.what();
  }
  return "";
}

void addOptions(CommandLine& line, Arguments& arguments)
{
  using endovascular_sim::tools::nonNegativeNumber;
  line.option("--link", arguments.link, "PATH", "path of the symbolic link under which the host finds the device")
      ->required();
  line.option("--scene", arguments.scene, "FILE", "the operator follows the scene's drive profile");
  line.overrides(arguments.overrides, "replaces a value of the scene");
  line.option("--script", arguments.script, "FILE",
              "the operator follows a CSV file: time [s], insertion [m], rotation [rad]");
  line.flag("--keyboard", arguments.keyboard,
            "arrow keys: up push, down pull, left and right twist; space grip, q end");
  line.option(
          "--start", arguments.start, "WHEN",
          "start of the motion: after the host's subscription (subscribed), or after the first enabled force of the "
          "simulation (enabled) [subscribed]")
      ->check(CLI::IsMember({"subscribed", "enabled"}));
  line.quantity("--seconds", arguments.seconds, "T", endovascular_sim::quantities::kDuration,
                "ends T seconds after the start of the motion; default: no end")
      ->check(nonNegativeNumber());
  line.quantity("--rate", arguments.rate, "HZ", endovascular_sim::quantities::kRate,
                "samples per second, 1 to 10000 [1000]")
      ->check(CLI::Range(1.0, 10000.0));
  line.option("--baud", arguments.baud, "N", "speed of the line [230400 bit/s]");
  line.option("--sample", arguments.sample, "KIND",
              "message of a sample: haptic (13 bytes), or joint_state with a Wrench for the force (about 100 bytes) "
              "[haptic]")
      ->check(CLI::IsMember({"haptic", "joint_state"}));
  line.quantity("--unplug-at", arguments.unplug_at, "T", endovascular_sim::quantities::kDuration,
                "unplugs the device T seconds after the start of the motion")
      ->check(nonNegativeNumber());
  line.quantity("--replug-after", arguments.replug_after, "T", endovascular_sim::quantities::kDuration,
                "plugs the restarted device in again T seconds later; default: never")
      ->check(nonNegativeNumber());
  line.option("--out", arguments.out, "FILE", "writes the measurements as JSON");
  line.option(
      "--trace", arguments.trace, "FILE",
      "writes hand and rendered force of every sample as CSV, with times of the device's clock (CLOCK_MONOTONIC)");
  line.require([&arguments] { return conflict(arguments); });
}

/** Hand controlled by the keyboard: each key moves the goal, and the hand follows at limited speed. */
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
    constexpr double speed = 50e-3;        // speed of the hand [m/s]
    constexpr double turning_speed = 6.0;  // angular speed of the hand [rad/s]
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
    constexpr double push = 2e-3;  // travel per key press [m]
    constexpr double twist = 0.1;  // rotation per key press [rad]
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
    endovascular_sim::tools::printWarnings("device_simulator", scene.warnings);
    const auto drive = scene.instruments.front().drive;
    options.duration = scene.duration;
    // The device reports displacements from its start; scene and host define the initial insertion of the wire.
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
  endovascular_sim::tools::writeFile(file, json.dump(2) + "\n");
}

void showHand(const DeviceSimulator& device)
{
  static const char* const states[] = {"disabled", "enabled ", "paused  ", "fault   "};
  const auto& force = device.renderedForce();
  std::printf("\rinsertion %8.2f mm  rotation %7.2f rad  force %7.3f N  torque %8.5f N m  %s ",
              1e3 * device.hand().insertion, device.hand().rotation, static_cast<double>(force.force),
              static_cast<double>(force.torque), states[static_cast<int>(force.state)]);
  std::fflush(stdout);
}

/** CSV file of hand and rendered force, one row per sample. */
class Trace
{
public:
  explicit Trace(const std::string& file) : file_(file), stream_(file)
  {
    if (!(stream_ << "time,insertion,rotation,force,torque,state\n"))
      throw endovascular_sim::writeError(file);
  }

  /** Adds a row if a sample was sent since the last one. @param now time [s] */
  void add(const DeviceSimulator& device, double now)
  {
    if (device.samples() == samples_)
      return;
    samples_ = device.samples();
    const auto& force = device.renderedForce();
    const std::string row =
        formatted("%.6f,%.9g,%.9g,%.9g,%.9g,%d\n", now, device.hand().insertion, device.hand().rotation,
                  static_cast<double>(force.force), static_cast<double>(force.torque), static_cast<int>(force.state));
    stream_ << row;
    if (samples_ % kRowsPerFlush == 0)
      flush();
  }

  /** @throws InputError when not everything could be written */
  void finish()
  {
    flush();
    errno = error_;
    if (error_ != 0)
      throw endovascular_sim::writeError(file_);
  }

private:
  void flush()
  {
    errno = 0;
    if (!stream_.flush() && error_ == 0)
      error_ = errno != 0 ? errno : EIO;
  }

  static constexpr std::uint64_t kRowsPerFlush = 50;
  std::string file_;
  std::ofstream stream_;
  std::uint64_t samples_ = 0;
  int error_ = 0;  ///< errno of the first failed write; 0: none
};

void waitUntil(double wake, int descriptor)
{
  const double wait = std::clamp(wake - steadyNow(), 0.0, 0.02);
  timespec timeout = {};
  timeout.tv_nsec = static_cast<long>(wait * 1e9);
  pollfd source = {descriptor, POLLIN, 0};
  ppoll(&source, 1, &timeout, nullptr);
}

/** Unplugs the device and plugs it in again at the given times. */
void updatePlug(DeviceSimulator& device, const Arguments& arguments, double now)
{
  const double time = device.motionTime(now);
  const bool out =
      device.hasStarted() && time >= arguments.unplug_at && time < arguments.unplug_at + arguments.replug_after;
  if (out && device.isPlugged())
    device.unplug();
  else if (!out && !device.isPlugged())
    device.plug(now);
}

int run(const Arguments& arguments)
{
  const auto keyboard = arguments.keyboard ? std::make_unique<KeyboardOperator>() : nullptr;
  DeviceSimulator device(simulatorOptions(arguments, keyboard.get()));
  std::optional<Trace> trace;
  if (!arguments.trace.empty())
    trace.emplace(arguments.trace);
  // A real device does not share its processor with the simulation: request real-time priority.
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
    updatePlug(device, arguments, now);
    device.step(now);
    if (trace)
      trace->add(device, now);
    waitUntil(device.isPlugged() ? device.wakeAt() : now + 5e-3, device.descriptor());
  }
  device.unplug();
  if (trace)
    trace->finish();
  writeReport(device.report(), arguments.out);
  return 0;
}

}  // namespace

int main(int argc, char** argv)
{
  namespace nodes = endovascular_sim::nodes;
  std::optional<nodes::ProcessorClaim> claim;  // empty without a ROS master: the simulator belongs to no session
  if (const char* const master = std::getenv("ROS_MASTER_URI"))
    nodes::avoidProcessor(claim.emplace(master, nodes::allowedProcessors()).choice().processor);
  Arguments arguments;
  CommandLine line(
      "device_simulator", "Emulates a haptic device on a pseudo-terminal: rosserial bytes at the speed of a real line.",
      "Exit code: 0 ended as requested or by a signal; 1 rejected (the reason is on the error stream); 2 wrong "
      "arguments.");
  addOptions(line, arguments);
  std::vector<std::string> words;
  ros::removeROSArgs(argc, argv, words);  // appended by roslaunch
  std::vector<const char*> pointers;
  pointers.reserve(words.size());
  for (const std::string& word : words)
    pointers.push_back(word.c_str());
  std::signal(SIGINT, requestStop);
  std::signal(SIGTERM, requestStop);
  return line.run(static_cast<int>(pointers.size()), pointers.data(), [&arguments] { return run(arguments); });
}
