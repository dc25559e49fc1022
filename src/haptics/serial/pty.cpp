#include "haptics/serial/pty.h"

#include <fcntl.h>
#include <termios.h>
#include <unistd.h>

#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <system_error>

#include "common/error.h"

namespace endovascular_sim::haptics
{

void Pty::plug(const std::string& link)
{
  unplug();
  // Only a symbolic link may be replaced.
  std::error_code error;
  const auto status = std::filesystem::symlink_status(link, error);
  if (std::filesystem::exists(status) && !std::filesystem::is_symlink(status))
    throw InputError(link, "", "exists and is not a symbolic link; choose another path for the device");
  master_ = posix_openpt(O_RDWR | O_NOCTTY | O_NONBLOCK | O_CLOEXEC);
  char name[128];
  if (master_ < 0 || grantpt(master_) != 0 || unlockpt(master_) != 0 || ptsname_r(master_, name, sizeof name) != 0)
    throw InputError("/dev/ptmx", "", std::string("no pseudo-terminal can be opened: ") + std::strerror(errno));
  host_path_ = name;
  slave_ = open(name, O_RDWR | O_NOCTTY | O_CLOEXEC);
  termios settings = {};
  if (slave_ >= 0 && tcgetattr(slave_, &settings) == 0)
  {
    cfmakeraw(&settings);
    tcsetattr(slave_, TCSANOW, &settings);
  }
  std::filesystem::remove(link, error);
  std::filesystem::create_symlink(host_path_, link, error);
  if (error)
    throw InputError(link, "",
                     "the symbolic link cannot be created: " + error.message() + "; choose a writable folder");
  link_ = link;
}

void Pty::unplug()
{
  if (!link_.empty())
  {
    // Another device may have replaced the link.
    std::error_code error;
    if (std::filesystem::read_symlink(link_, error) == host_path_)
      std::filesystem::remove(link_, error);
  }
  link_.clear();
  for (int* descriptor : {&slave_, &master_})
  {
    if (*descriptor >= 0)
      close(*descriptor);
    *descriptor = -1;
  }
}

std::size_t Pty::read(std::uint8_t* data, std::size_t size)
{
  const ssize_t count = master_ < 0 ? 0 : ::read(master_, data, size);
  return count > 0 ? static_cast<std::size_t>(count) : 0;
}

std::size_t Pty::write(const std::uint8_t* data, std::size_t size)
{
  const ssize_t count = master_ < 0 ? 0 : ::write(master_, data, size);
  return count > 0 ? static_cast<std::size_t>(count) : 0;
}

}  // namespace endovascular_sim::haptics
