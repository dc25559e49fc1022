#pragma once

#include <string>
#include <vector>

namespace endovascular_sim
{

/** Fields of a line that a separator divides. Quotes enclose fields with separators. */
inline std::vector<std::string> csvFields(const std::string& line, char separator = ',')
{
  std::vector<std::string> fields(1);
  bool is_quoted = false;
  for (const char c : line)
    if (c == '"')
      is_quoted = !is_quoted;
    else if (c == separator && !is_quoted)
      fields.emplace_back();
    else
      fields.back() += c;
  return fields;
}

}  // namespace endovascular_sim
