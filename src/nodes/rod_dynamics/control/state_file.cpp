#include "nodes/rod_dynamics/control/state_file.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstdio>
#include <filesystem>
#include <random>
#include <system_error>

#include "common/error.h"
#include "common/output_file.h"
#include "simulation/saved_state.h"

namespace endovascular_sim::nodes
{
namespace
{

constexpr auto kRemedy = "give the path of a state saved with simulation/save_state or simulate --save-state";
constexpr off_t kLargestState = off_t{256} << 20;  ///< beyond every saved state [B]
constexpr mode_t kMode = 0644;

/** Open file, closed at the end of its scope. */
class Descriptor
{
public:
  Descriptor(const std::string& path, int flags) : value_(open(path.c_str(), flags | O_CLOEXEC, kMode)) {}
  ~Descriptor()
  {
    if (value_ >= 0)
      close(value_);
  }
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;

  bool isOpen() const { return value_ >= 0; }
  int value() const { return value_; }

private:
  int value_;
};

/** @throws std::filesystem::filesystem_error for a path that cannot be resolved */
std::string resolvedBelow(const std::string& file, const std::string& folder, const char* service)
{
  namespace fs = std::filesystem;
  if (file.empty())
    throw InputError(service, "file", std::string("is empty; ") + kRemedy);
  if (folder.empty())
    return fs::absolute(file).string();
  const fs::path allowed = fs::weakly_canonical(fs::absolute(folder));
  const fs::path path = allowed / file;  // an absolute file replaces the folder
  const fs::path parent = fs::weakly_canonical(path.parent_path());
  const fs::path below = parent.lexically_relative(allowed);
  if (below.empty() || *below.begin() == "..")
    throw InputError(service, "file",
                     file + " is not below ~state_folder, " + allowed.string() + "; give a file there");
  return (parent / path.filename()).string();
}

/** Complete path of a file, which must lie below a folder. */
std::string pathBelow(const std::string& file, const std::string& folder, const char* service)
{
  try
  {
    return resolvedBelow(file, folder, service);
  }
  catch (const std::filesystem::filesystem_error& error)
  {
    throw InputError(service, "file", file + " cannot be resolved (" + error.code().message() + ")");
  }
}

/** Reads the first bytes of an open file. */
bool holdsState(int file)
{
  std::array<char, simulation::kStateMagic.size()> begin{};
  const ssize_t size = pread(file, begin.data(), begin.size(), 0);
  return size > 0 && simulation::beginsAsState({begin.data(), static_cast<std::size_t>(size)});
}

/** Refuses an existing file that is no saved state, and anything but a file. */
void requireReplaceable(const std::string& path)
{
  struct stat status = {};
  if (lstat(path.c_str(), &status) != 0 && errno == ENOENT)
    return;
  const Descriptor file(path, O_RDONLY | O_NOFOLLOW | O_NONBLOCK);
  if (!S_ISREG(status.st_mode) || !file.isOpen() || !holdsState(file.value()))
    throw InputError(path, "", "exists and is no saved state, so it is not replaced; choose another file");
}

/** Name of a file beside another one, which nobody can foresee. */
std::string unforeseeableName(const std::string& path)
{
  std::random_device random;
  std::array<char, 24> suffix{};
  std::snprintf(suffix.data(), suffix.size(), ".%08x%08x.part", random(), random());
  return path + suffix.data();
}

/** Writes a new file. @throws InputError when it exists, or cannot be written */
void writeNewFile(const std::string& path, const std::string& bytes)
{
  const Descriptor file(path, O_WRONLY | O_CREAT | O_EXCL | O_NOFOLLOW);
  if (!file.isOpen())
    throw writeError(path);
  for (std::size_t done = 0; done < bytes.size();)
  {
    const ssize_t count = write(file.value(), bytes.data() + done, bytes.size() - done);
    if (count < 0 && errno == EINTR)
      continue;
    if (count < 0)
    {
      const InputError error = writeError(path);
      unlink(path.c_str());
      throw error;
    }
    done += static_cast<std::size_t>(count);
  }
}

}  // namespace

std::string writeStateFile(const std::string& file, const std::string& state, const std::string& folder)
{
  const std::string path = pathBelow(file, folder, "simulation/save_state");
  requireReplaceable(path);
  const std::string part = unforeseeableName(path);
  writeNewFile(part, state);
  std::error_code error;
  std::filesystem::rename(part, path, error);
  if (error)
  {
    unlink(part.c_str());
    throw InputError(path, "", "cannot be written (" + error.message() + "); choose another file");
  }
  return path;
}

std::string readStateFile(const std::string& file, const std::string& folder)
{
  const std::string path = pathBelow(file, folder, "simulation/load_state");
  errno = 0;
  const Descriptor descriptor(path, O_RDONLY | O_NONBLOCK);  // the name of a pipe does not block
  struct stat status = {};
  if (!descriptor.isOpen() || fstat(descriptor.value(), &status) != 0)
    throw InputError(path, "", "cannot be read (" + systemReason() + "); " + kRemedy);
  if (!S_ISREG(status.st_mode))
    throw InputError(path, "", std::string("is no file; ") + kRemedy);
  if (!holdsState(descriptor.value()))
    throw InputError(path, "", std::string("is not a saved state; ") + kRemedy);
  if (status.st_size > kLargestState)
    throw InputError(path, "", std::string("is larger than any saved state (256 MB); ") + kRemedy);
  std::string state(static_cast<std::size_t>(status.st_size), '\0');
  std::size_t done = 0;
  while (done < state.size())
  {
    const ssize_t count = read(descriptor.value(), &state[done], state.size() - done);
    if (count < 0 && errno == EINTR)
      continue;
    if (count <= 0)
      throw InputError(path, "", std::string("cannot be read to its end; ") + kRemedy);
    done += static_cast<std::size_t>(count);
  }
  return state;
}

}  // namespace endovascular_sim::nodes
