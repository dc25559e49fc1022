#include "common/output_file.h"

#include <cerrno>
#include <filesystem>
#include <fstream>
#include <system_error>

namespace endovascular_sim
{
namespace
{

/** Remedy of a failed write. */
const char* remedyOf(int error)
{
  switch (error)
  {
    case ENOSPC:
    case EDQUOT:
      return "free some space, or choose a folder on another disk";
    case EACCES:
    case EPERM:
    case EROFS:
      return "choose a folder in which this account may write";
    case ENOENT:
    case ENOTDIR:
      return "choose an existing folder";
    case EISDIR:
      return "give the path of a file, not of a folder";
    default:
      return "choose an existing, writable folder with free space";
  }
}

}  // namespace

std::string systemReason()
{
  return errno == 0 ? "unknown reason" : std::generic_category().message(errno);
}

InputError writeError(const std::string& file)
{
  const int error = errno;
  return {file, "", "cannot be written (" + systemReason() + "); " + remedyOf(error)};
}

void createFolder(const std::string& folder)
{
  std::error_code reason;
  std::filesystem::create_directories(folder, reason);
  if (reason || !std::filesystem::is_directory(folder))
  {
    const int error = reason ? reason.value() : ENOTDIR;
    throw InputError(
        folder, "",
        "the folder cannot be created (" + std::generic_category().message(error) + "); " + remedyOf(error));
  }
}

void writeTextFile(const std::string& file, const std::string& text)
{
  errno = 0;
  std::ofstream stream(file);
  if (!(stream << text) || !stream.flush())
    throw writeError(file);
}

}  // namespace endovascular_sim
