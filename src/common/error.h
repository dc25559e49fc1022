#pragma once

#include <stdexcept>
#include <string>

namespace endovascular_sim
{

/** Input that cannot be used: says which file, which key or element, and what would be right. */
class InputError : public std::runtime_error
{
public:
  /** @param file path of the offending file, or the name of the source (a topic, a service)
   *  @param where key, line or element inside it; empty when it is the file as a whole
   *  @param remedy what is wrong and what would be right */
  InputError(const std::string& file, const std::string& where, const std::string& remedy)
    : std::runtime_error(file + (where.empty() ? "" : ": " + where) + ": " + remedy)
  {
  }
};

}  // namespace endovascular_sim
