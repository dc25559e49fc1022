#pragma once

#include <string>

#include "haptics/serial/write_queue.h"

namespace endovascular_sim::haptics
{

/** Serial line or pseudo-terminal in raw, non-blocking mode, opened exclusively. */
class SerialPort : public ByteSink
{
public:
  SerialPort() = default;
  ~SerialPort() override { close(); }
  SerialPort(const SerialPort&) = delete;
  SerialPort& operator=(const SerialPort&) = delete;

  /** Checks a baud rate.
   *  @param where name of the parameter, for the error message
   *  @throws InputError for one that no serial line has */
  static void checkBaud(int baud, const std::string& where);

  /** Opens the line.
   *  @param path device file or symbolic link to it, e.g. /dev/serial/by-id/...
   *  @param baud any speed; drivers of adapters may refuse some [bit/s]
   *  @return false on failure, with the reason in error() */
  bool open(const std::string& path, int baud);
  void close();

  /** @return number of bytes read; 0 if none are available or the line is lost */
  std::size_t read(std::uint8_t* data, std::size_t size);
  std::size_t write(const std::uint8_t* data, std::size_t size) override;

  bool isOpen() const { return descriptor_ >= 0; }
  /** True after the peer has disconnected; the line must be closed and reopened. */
  bool isLost() const { return lost_; }
  int descriptor() const { return descriptor_; }
  const std::string& error() const { return error_; }

private:
  bool configure(int baud);
  bool refuse(const std::string& reason);
  void markLost(const std::string& reason);

  int descriptor_ = -1;
  bool lost_ = false;
  std::string error_;
};

}  // namespace endovascular_sim::haptics
