#pragma once

#include <string>

#include "haptics/host/rosserial_host.h"
#include "haptics/serial/serial_port.h"

namespace endovascular_sim::haptics
{

struct LinkOptions
{
  std::string port;   ///< path of the device file, or of a symbolic link to it
  int baud = 230400;  ///< speed of the line [bit/s]
  HostOptions host;   ///< options of the host; its baud is overwritten by the one above
};

/** Rosserial host on a hot-pluggable serial line: opens the line, serves it, and reopens it after an unplug.
 *
 *  Times `now` are seconds of a steady clock. Not thread-safe. No call blocks. */
class HapticLink
{
public:
  /** @throws InputError for a baud rate that no serial line has */
  explicit HapticLink(LinkOptions options);

  /** Performs all pending work: opens the line, reads, runs the watchdogs, writes. */
  void service(double now, const WallTime& wall);
  /** Sets the force computed for the motion @p caused_by, and sends it at once if the line is free. */
  void commandForce(const HandForce& force, const HandMotion& caused_by, double now, const WallTime& wall);
  /** Sets the state of the simulation (RosserialHost::setSimulationState()), and notifies the device at once. */
  void setSimulationState(const std::string& reason, double now, const WallTime& wall);
  /** Queues zero force and TX_STOP; call flush() afterwards until isIdle(). */
  void shutDown(double now, const WallTime& wall);
  /** Writes queued frames to the line. */
  void flush(double now);
  bool isIdle() const { return host_.output().empty() || !port_.isOpen(); }

  /** Descriptor to poll; negative while the line is closed. */
  int descriptor() const { return port_.descriptor(); }
  /** True if the caller should poll for writability. */
  bool waitsForWrite() const { return host_.output().blocked(); }
  /** Latest time for the next service() [s]. */
  double wakeAt() const;

  RosserialHost& host() { return host_; }
  const RosserialHost& host() const { return host_; }
  bool isOpen() const { return port_.isOpen(); }
  std::uint64_t opened() const { return opened_; }  ///< number of openings of the line; one more than reconnections
  const std::string& lastError() const { return last_error_; }
  const std::string& portName() const { return options_.port; }

private:
  void tryToOpen(double now);
  void readAll(double now, const WallTime& wall);
  void dropLostLine(double now);

  LinkOptions options_;
  SerialPort port_;
  RosserialHost host_;
  double open_at_ = 0.0;  ///< time of the next attempt to open the line [s]
  std::uint64_t opened_ = 0;
  std::string last_error_;
};

}  // namespace endovascular_sim::haptics
