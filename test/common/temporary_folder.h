#pragma once

#include <stdlib.h>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <stdexcept>
#include <string>

namespace endovascular_sim
{

/** Content of a file; empty if it is missing. */
inline std::string contentOf(const std::filesystem::path& file)
{
  std::ifstream stream(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), {}};
}

/** New folder for the files of a test, removed with all of them at its end. */
class TemporaryFolder
{
public:
  TemporaryFolder()
  {
    std::string name = (std::filesystem::temp_directory_path() / "endovascular_sim_XXXXXX").string();
    if (::mkdtemp(name.data()) == nullptr)
      throw std::runtime_error(name + ": cannot make a temporary folder");
    path_ = name;
  }
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;
  ~TemporaryFolder()
  {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
  }

  const std::filesystem::path& path() const { return path_; }

  /** Path of a file in the folder. */
  std::string file(const std::string& name) const { return (path_ / name).string(); }

  /** Path of a file in the folder with this content. */
  std::string write(const std::string& name, const std::string& content) const
  {
    std::ofstream(path_ / name, std::ios::binary) << content;
    return file(name);
  }

private:
  std::filesystem::path path_;
};

}  // namespace endovascular_sim
