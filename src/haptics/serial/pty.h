#pragma once

#include <string>

#include "haptics/serial/write_queue.h"

namespace endovascular_sim::haptics
{

/** Device end of a pseudo-terminal pair, raw and non-blocking. A symbolic link names the host end, which appears to the
 *  host as a hot-pluggable serial line. */
class Pty : public ByteSink
{
public:
  Pty() = default;
  ~Pty() override { unplug(); }
  Pty(const Pty&) = delete;
  Pty& operator=(const Pty&) = delete;

  /** Opens a new pair and creates the symbolic link, replacing a stale one.
   *  @throws InputError if the pair or the link cannot be created */
  void plug(const std::string& link);
  /** Removes the link and closes the pair: a hang-up for the host. */
  void unplug();

  bool isPlugged() const { return master_ >= 0; }
  int descriptor() const { return master_; }

  /** @return number of bytes read; 0 if none are available */
  std::size_t read(std::uint8_t* data, std::size_t size);
  /** @return number of bytes accepted; fewer than @p size if the terminal's buffer is full */
  std::size_t write(const std::uint8_t* data, std::size_t size) override;

private:
  int master_ = -1;
  int slave_ = -1;  ///< held open so that the pair outlives a host that disconnects
  std::string link_;
  std::string host_path_;
};

}  // namespace endovascular_sim::haptics
