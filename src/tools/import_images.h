#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "common/error.h"
#include "common/process/child_process.h"

namespace endovascular_sim::tools
{

/** Converts images by volume_import, which lies beside the running program.
 *  @param choices further arguments
 *  @throws InputError if it is missing, or rejects the images for a reason that it has printed */
inline void importImages(const std::string& images, const std::string& volume, const std::vector<std::string>& choices)
{
  const std::filesystem::path program = std::filesystem::read_symlink("/proc/self/exe").parent_path() / "volume_import";
  if (!std::filesystem::exists(program))
    throw InputError(images, "",
                     "is no .vol file, and volume_import is not built; install libinsighttoolkit5-dev and build again");
  std::vector<std::string> command = {program.string(), images, "--out", volume};
  command.insert(command.end(), choices.begin(), choices.end());
  if (runProgram(command) != 0)
    throw InputError(images, "", "was rejected by volume_import for the reason above");
}

}  // namespace endovascular_sim::tools
