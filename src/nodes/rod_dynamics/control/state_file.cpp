#include "nodes/rod_dynamics/control/state_file.h"

#include <filesystem>
#include <fstream>
#include <iterator>
#include <system_error>

#include "common/error.h"
#include "common/input_file.h"
#include "common/output_file.h"

namespace endovascular_sim::nodes
{
namespace
{

constexpr auto kRemedy = "give the path of a state saved with simulation/save_state or simulate --save-state";

}  // namespace

std::string writeStateFile(const std::string& file, const std::string& state)
{
  if (file.empty())
    throw InputError("simulation/save_state", "file", "is empty; give the path of the file to write");
  const std::string path = std::filesystem::absolute(file).string();
  const std::string part = path + ".part";
  writeTextFile(part, state);
  std::error_code error;
  std::filesystem::rename(part, path, error);
  if (error)
  {
    std::error_code ignored;
    std::filesystem::remove(part, ignored);
    throw InputError(path, "", "cannot be written (" + error.message() + "); choose another file");
  }
  return path;
}

std::string readStateFile(const std::string& file)
{
  if (file.empty())
    throw InputError("simulation/load_state", "file", std::string("is empty; ") + kRemedy);
  std::error_code error;
  if (std::filesystem::exists(file, error) && !std::filesystem::is_regular_file(file, error))
    throw InputError(file, "", std::string("is no file; ") + kRemedy);
  std::ifstream stream = openInputFile(file, kRemedy, std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>()};
}

}  // namespace endovascular_sim::nodes
