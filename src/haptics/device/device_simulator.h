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

/** Condition on which the simulated operator starts to move. */
enum class StartCondition
{
  kSubscribed,  ///< the host has subscribed to the device's topics
  kEnabled,     ///< forces of the simulation arrive
};

struct SimulatorOptions
{
  std::string link;        ///< path of the symbolic link to the device's pseudo-terminal
  double baud = 230400.0;  ///< speed of the line [bit/s]
  double rate = 1000.0;    ///< sampling rate [Hz]
  StartCondition start = StartCondition::kSubscribed;
  DeviceOptions device;
  /** Position of the operator's hand at time t since the start of the motion [s]. */
  std::function<HandMotion(double t)> motion;
  double duration = 0.0;  ///< duration of the operator's script [s]; infinite without one
};

/** Software haptic device: sends rosserial frames over a pseudo-terminal at the speed of a serial line, moves a
 *  scripted hand, and measures the latency of the forces. Times `now` are seconds of a steady clock. */
class DeviceSimulator
{
public:
  explicit DeviceSimulator(SimulatorOptions options);

  /** Connects the device; its clock and its position count restart at zero. */
  void plug(double now);
  void unplug();

  /** Advances the line and the hand to time @p now [s]. */
  void step(double now);
  /** Latest time for the next step() [s]; a step is due earlier if descriptor() is readable. */
  double wakeAt() const;
  int descriptor() const { return pty_.descriptor(); }
  bool isPlugged() const { return pty_.isPlugged(); }

  /** Sets the flags of the following samples, e.g. 0 for a released handle or HapticSample::kFault. */
  void setFlags(std::uint8_t flags) { flags_ = flags; }

  bool hasStarted() const { return started_at_.has_value(); }
  /** Time since the start of the motion, 0 before it [s]. */
  double motionTime(double now) const { return started_at_ ? now - *started_at_ : 0.0; }
  const HandMotion& hand() const { return hand_; }
  std::uint64_t samples() const { return report_.samples; }  ///< number of samples sent
  /** Force that the device renders. */
  const HapticForce& renderedForce() const { return device_->renderedForce(); }

  struct Report
  {
    LatencyRecord latency;  ///< age of the sample that a force responds to, at the arrival of each enabled force
    LatencyRecord motion_to_force;      ///< latency of the first force in response to each sample with motion
    std::uint64_t samples = 0;          ///< samples sent
    std::uint64_t samples_skipped = 0;  ///< samples not sent because the simulator was late
    std::uint64_t forces = 0;           ///< forces received
    std::uint64_t enabled_forces = 0;   ///< forces received in state enabled
    double first_force_at = 0.0;        ///< arrival of the first force [s]
    double last_force_at = 0.0;         ///< arrival of the last force [s]
    double largest_force = 0.0;         ///< largest absolute force [N]
    double largest_torque = 0.0;        ///< largest absolute torque [N·m]
    std::uint64_t watchdog_trips = 0;   ///< timeouts of the device's force watchdog
    std::uint64_t stops = 0;            ///< TX_STOP frames received
    std::uint64_t bytes_lost = 0;       ///< bytes lost to full buffers of the line
    std::uint64_t resyncs = 0;          ///< losses of frame synchronisation
    std::uint64_t unplugged = 0;        ///< number of disconnections
    /** Mean rate of force frames between the first and the last one [Hz]. */
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
  HandMotion zero_;                        ///< position of the hand when the device was connected
  std::deque<std::uint32_t> moved_times_;  ///< device times of samples with motion and without a response yet [µs]
};

}  // namespace endovascular_sim::haptics
