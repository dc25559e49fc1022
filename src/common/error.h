#pragma once

#include <stdexcept>
#include <string>

namespace endovascular_sim
{

/** Error in an input: names the file, the key or element, and the remedy. */
class InputError : public std::runtime_error
{
public:
  /** @param file path of the offending file, or the name of the source (a topic, a service)
   *  @param where key, line or element inside the file; empty for the file as a whole
   *  @param remedy description of the error and of a valid input */
  InputError(const std::string& file, const std::string& where, const std::string& remedy)
    : std::runtime_error(file + (where.empty() ? "" : ": " + where) + ": " + remedy)
  {
  }
};

}  // namespace endovascular_sim
