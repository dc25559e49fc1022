#pragma once

#include <string>

#include "haptics/serial/write_queue.h"

namespace endovascular_sim::haptics
{

/** The device's end of a pseudo-terminal, raw and non-blocking, with a link that names the host's end: to the host it
 *  is a serial line that can be unplugged. */
class Pty : public ByteSink
{
public:
  Pty() = default;
  ~Pty() override { unplug(); }
  Pty(const Pty&) = delete;
  Pty& operator=(const Pty&) = delete;

  /** Opens a new pair and makes the link, replacing a stale one.
   *  @throws InputError when the pair or the link cannot be made */
  void plug(const std::string& link);
  /** Removes the link and closes: the host sees a hang-up. */
  void unplug();

  bool isPlugged() const { return master_ >= 0; }
  int descriptor() const { return master_; }
  /** Path of the host's end, e.g. /dev/pts/3. */
  const std::string& hostPath() const { return host_path_; }

  /** @return bytes read, 0 when there are none now */
  std::size_t read(std::uint8_t* data, std::size_t size);
  /** @return bytes taken; what the terminal has no room for is not */
  std::size_t write(const std::uint8_t* data, std::size_t size) override;

private:
  int master_ = -1;
  int slave_ = -1;  ///< held open so that the pair survives a host that comes and goes
  std::string link_;
  std::string host_path_;
};

}  // namespace endovascular_sim::haptics
