#pragma once

#include <string>

namespace endovascular_sim
{

/** Largest length of a file name that fileNameOf() returns [characters]. */
constexpr std::size_t kLongestFileName = 100;

/** Valid name of a file or folder, in no case a path, from any text: letters, digits, `_`, `-` and `.`, with a letter,
 *  digit or `_` first. Other characters become `_`; a valid name stays unchanged, and an empty one becomes `_`. */
inline std::string fileNameOf(const std::string& text)
{
  const auto isPlain = [](char c)
  { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_'; };
  std::string name = text.substr(0, kLongestFileName);
  for (std::size_t k = 0; k < name.size(); ++k)
    if (!isPlain(name[k]) && (k == 0 || (name[k] != '-' && name[k] != '.')))
      name[k] = '_';
  return name.empty() ? "_" : name;
}

}  // namespace endovascular_sim
