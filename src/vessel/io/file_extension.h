#pragma once

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <string>

namespace endovascular_sim::vessel
{

/** Extension of a file's name in lower case, with its dot. */
inline std::string lowerCaseExtension(const std::string& path)
{
  std::string extension = std::filesystem::path(path).extension().string();
  std::transform(extension.begin(), extension.end(), extension.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return extension;
}

}  // namespace endovascular_sim::vessel
