#pragma once

#include <string>

#include "haptics/serial/write_queue.h"

namespace endovascular_sim::haptics
{

/** A serial line or pty: raw (no byte is changed), non-blocking, opened exclusively. */
class SerialPort : public ByteSink
{
public:
  SerialPort() = default;
  ~SerialPort() override { close(); }
  SerialPort(const SerialPort&) = delete;
  SerialPort& operator=(const SerialPort&) = delete;

  /** @throws InputError for a speed that termios does not have; @p where names the parameter it came from */
  static void checkBaud(int baud, const std::string& where);

  /** @param path device file or a link to one, e.g. /dev/serial/by-id/...
   *  @return false when it cannot be opened now; error() says why */
  bool open(const std::string& path, int baud);
  void close();

  /** @return bytes read, 0 when there are none now or the line is lost */
  std::size_t read(std::uint8_t* data, std::size_t size);
  std::size_t write(const std::uint8_t* data, std::size_t size) override;

  bool isOpen() const { return descriptor_ >= 0; }
  /** The other side is gone (unplugged): close and open again. */
  bool isLost() const { return lost_; }
  int descriptor() const { return descriptor_; }
  const std::string& error() const { return error_; }

private:
  bool configure(int baud);
  void lose(const std::string& reason);

  int descriptor_ = -1;
  bool lost_ = false;
  std::string error_;
};

}  // namespace endovascular_sim::haptics
