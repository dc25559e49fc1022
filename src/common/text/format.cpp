#include "common/text/format.h"

#include <cstdarg>
#include <cstdio>

namespace endovascular_sim
{

std::string formatted(const char* format, ...)
{
  std::va_list values;
  va_start(values, format);
  std::va_list again;
  va_copy(again, values);
  std::string text(static_cast<std::size_t>(std::vsnprintf(nullptr, 0, format, values)), '\0');
  va_end(values);
  std::vsnprintf(text.data(), text.size() + 1, format, again);
  va_end(again);
  return text;
}

std::string shortNumber(double value, int digits)
{
  return formatted("%.*g", digits, value);
}

std::string inMillimetres(double length)
{
  return shortNumber(1e3 * length, 4) + " mm";
}

std::string inMillimetres(const Eigen::Vector3d& position)
{
  return formatted("(%.1f, %.1f, %.1f) mm", 1e3 * position.x(), 1e3 * position.y(), 1e3 * position.z());
}

}  // namespace endovascular_sim
