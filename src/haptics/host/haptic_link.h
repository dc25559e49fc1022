#pragma once

#include <string>

#include "haptics/host/rosserial_host.h"
#include "haptics/serial/serial_port.h"

namespace endovascular_sim::haptics
{

struct LinkOptions
{
  std::string port;   ///< device file or a link to one
  int baud = 230400;  ///< [bit/s]
  HostOptions host;   ///< its baud is set from the one above
};

/** A rosserial host on a serial line that may come and go: opens it, serves it, opens it again after an unplug.
 *
 *  Times `now` are seconds of a steady clock. Not thread-safe; nothing here blocks. */
class HapticLink
{
public:
  /** @throws InputError when the speed is not one of a serial line */
  explicit HapticLink(LinkOptions options);

  /** Opens, reads, watches, writes: everything that is due. */
  void service(double now, const WallTime& wall);
  /** A new force from the simulation: goes out at once when the line is free. */
  void commandForce(const HandForce& force, const HandMotion& caused_by, double now, const WallTime& wall);
  /** Queues zero force and TX_STOP; service the output with flush() until isIdle(). */
  void shutDown(double now, const WallTime& wall);
  void flush(double now);
  bool isIdle() const { return host_.output().empty() || !port_.isOpen(); }

  /** What to poll: the descriptor (negative when closed), whether to wait until it takes bytes. */
  int descriptor() const { return port_.descriptor(); }
  bool waitsForWrite() const { return host_.output().blocked(); }
  /** Latest time for the next service() [s]. */
  double wakeAt() const;

  RosserialHost& host() { return host_; }
  const RosserialHost& host() const { return host_; }
  bool isOpen() const { return port_.isOpen(); }
  std::uint64_t opened() const { return opened_; }  ///< times that the line was opened; reconnects are one less
  const std::string& lastError() const { return last_error_; }
  const std::string& portName() const { return options_.port; }

private:
  void tryToOpen(double now);
  void readAll(double now, const WallTime& wall);
  void dropLostLine(double now);

  LinkOptions options_;
  SerialPort port_;
  RosserialHost host_;
  double open_at_ = 0.0;  ///< next attempt [s]
  std::uint64_t opened_ = 0;
  std::string last_error_;
};

}  // namespace endovascular_sim::haptics
