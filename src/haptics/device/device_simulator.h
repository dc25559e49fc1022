#pragma once

#include <cstdint>
#include <deque>
#include <functional>
#include <optional>
#include <string>

#include "haptics/device/rosserial_device.h"
#include "haptics/device/serial_line.h"
#include "haptics/force/motion_reference.h"
#include "haptics/host/latency_record.h"
#include "haptics/serial/pty.h"

namespace endovascular_sim::haptics
{

/** What makes the simulated operator begin to move. */
enum class StartCondition
{
  kSubscribed,  ///< the host has taken the device's topics
  kEnabled,     ///< forces of the simulation come back
};

struct SimulatorOptions
{
  std::string link;        ///< name under which the host finds the device
  double baud = 230400.0;  ///< [bit/s]
  double rate = 1000.0;    ///< of the samples [Hz]
  StartCondition start = StartCondition::kSubscribed;
  DeviceOptions device;
  /** The operator's hand at time t [s] since the start of the motion. */
  std::function<HandMotion(double t)> motion;
  double duration = 0.0;  ///< of the operator's script; infinite without one [s]
};

/** A haptic device in software: real bytes on a real pty at the speed of a real line, a hand that moves, and a
 * stopwatch for the force that answers. Times `now` are seconds of a steady clock. */
class DeviceSimulator
{
public:
  explicit DeviceSimulator(SimulatorOptions options);

  /** Switches the device on: its clock and its count begin at zero. */
  void plug(double now);
  void unplug();

  /** Moves bytes and the hand on to @p now. */
  void step(double now);
  /** Latest time for the next step(); earlier when descriptor() has bytes [s]. */
  double wakeAt() const;
  int descriptor() const { return pty_.descriptor(); }
  bool isPlugged() const { return pty_.isPlugged(); }

  /** The hand lets go (flags 0), or the device fails. */
  void setFlags(std::uint8_t flags) { flags_ = flags; }

  bool hasStarted() const { return started_at_.has_value(); }
  /** Since the start of the motion, 0 before it [s]. */
  double motionTime(double now) const { return started_at_ ? now - *started_at_ : 0.0; }
  const HandMotion& hand() const { return hand_; }
  const HapticForce& shown() const { return device_->shown(); }

  struct Report
  {
    LatencyRecord latency;          ///< age, at arrival, of the sample that a force answers, every enabled force
    LatencyRecord motion_to_force;  ///< the same, first answer to a sample that moved
    std::uint64_t samples = 0;
    std::uint64_t samples_skipped = 0;  ///< due while the simulator itself was late
    std::uint64_t forces = 0;
    std::uint64_t enabled_forces = 0;
    double first_force_at = 0.0;  ///< [s]
    double last_force_at = 0.0;   ///< [s]
    double largest_force = 0.0;   ///< [N]
    double largest_torque = 0.0;  ///< [N·m]
    std::uint64_t watchdog_trips = 0;
    std::uint64_t stops = 0;       ///< TX_STOP of the host
    std::uint64_t bytes_lost = 0;  ///< the line could not carry them
    std::uint64_t resyncs = 0;
    std::uint64_t unplugged = 0;
    /** Frames per second between the first and the last force [Hz]. */
    double forceRate() const;
  };
  Report report() const;

private:
  void takeSample(double now);
  void moveBytes(double now);
  void record(const HapticForce& force, double now);
  std::uint32_t clock(double now) const;
  void collect(Report& report) const;

  SimulatorOptions options_;
  Pty pty_;
  std::optional<RosserialDevice> device_;
  SerialLine to_host_;
  SerialLine from_host_;
  Report report_;

  double plugged_at_ = 0.0;
  double next_sample_at_ = 0.0;
  std::optional<double> started_at_;
  bool enabled_seen_ = false;
  std::uint8_t flags_ = HapticSample::kEnabled;
  HandMotion hand_;
  HandMotion zero_;                        ///< where the hand was when the device was switched on
  std::deque<std::uint32_t> moved_times_;  ///< clocks of samples that moved and have no answer yet
};

}  // namespace endovascular_sim::haptics
