#include "common/input_file.h"

#include <cerrno>
#include <filesystem>

#include "common/error.h"
#include "common/output_file.h"

namespace endovascular_sim
{

std::ifstream openInputFile(const std::string& file, const std::string& remedy, std::ios::openmode mode)
{
  std::error_code ignored;
  const bool folder = std::filesystem::is_directory(file, ignored);
  errno = 0;
  std::ifstream stream(file, mode);
  if (folder)
    errno = EISDIR;  // a folder can be opened, but not read
  if (folder || !stream)
    throw InputError(file, "", "cannot be read (" + systemReason() + "); " + remedy);
  return stream;
}

}  // namespace endovascular_sim
