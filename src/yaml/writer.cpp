#include "yaml/writer.h"

#include <array>
#include <charconv>
#include <cmath>

#include "common/error.h"

namespace endovascular_sim::yaml
{
namespace
{

std::string formatted(double value)
{
  if (std::isinf(value))
    return value > 0.0 ? ".inf" : "-.inf";
  std::array<char, 40> buffer;
  const auto result = std::to_chars(buffer.data(), buffer.data() + buffer.size(), value);
  return {buffer.data(), result.ptr};
}

std::string formatted(const double* values, std::size_t size)
{
  std::string text = "[";
  for (std::size_t i = 0; i < size; ++i)
    text += (i == 0 ? "" : ", ") + formatted(values[i]);
  return text + "]";
}

}  // namespace

std::string quoted(const std::string& value)
{
  static const char* digits = "0123456789abcdef";
  std::string text = "\"";
  for (const char c : value)
  {
    const auto byte = static_cast<unsigned char>(c);
    if (c == '"' || c == '\\')
      text += std::string("\\") + c;
    else if (byte < 0x20)
      text += std::string("\\x") + digits[byte >> 4] + digits[byte & 0xf];
    else
      text += c;
  }
  return text + "\"";
}

void Writer::line(const std::string& key, const std::string& value)
{
  yaml_ +=
      std::string(static_cast<std::size_t>(depth_) * 2, ' ') + key + ":" + (value.empty() ? "" : " ") + value + "\n";
}

void Writer::number(const std::string& key, double& value, const Quantity& /*quantity*/, const Range& range,
                    Need /*need*/)
{
  if (!range.contains(value))
    reject(key, "is " + std::to_string(value) + "; must be " + range.description());
  line(key, formatted(value));
}

void Writer::optionalNumber(const std::string& key, double& value, const Quantity& quantity, const Range& range)
{
  if (!std::isnan(value))
    number(key, value, quantity, range, Need::kOptional);
}

void Writer::integer(const std::string& key, int& value, int /*min*/, int /*max*/, Need /*need*/)
{
  line(key, std::to_string(value));
}

void Writer::bigInteger(const std::string& key, std::uint64_t& value)
{
  line(key, std::to_string(value));
}

void Writer::boolean(const std::string& key, bool& value)
{
  line(key, value ? "true" : "false");
}

void Writer::text(const std::string& key, std::string& value, Need /*need*/)
{
  if (!value.empty())
    line(key, quoted(value));
}

void Writer::choice(const std::string& key, int& value, const std::vector<std::string>& words, Need /*need*/)
{
  line(key, words.at(static_cast<std::size_t>(value)));
}

void Writer::numbers(const std::string& key, double* values, int size, const Quantity& /*quantity*/, Need /*need*/)
{
  line(key, formatted(values, static_cast<std::size_t>(size)));
}

void Writer::rows(const std::string& key, std::vector<std::vector<double>>& values,
                  const std::vector<Quantity>& /*columns*/, Need /*need*/)
{
  std::string text;
  for (const std::vector<double>& row : values)
    text += (text.empty() ? "" : ", ") + formatted(row.data(), row.size());
  line(key, "[" + text + "]");
}

void Writer::map(const std::string& key, const Visit& visit)
{
  Writer child(depth_ + 1);
  visit(child);
  line(key, child.yaml_.empty() ? "{}" : "");
  yaml_ += child.yaml_;
}

void Writer::list(const std::string& key, std::size_t size, const std::function<void(std::size_t)>& /*resize*/,
                  const std::function<void(Fields&, std::size_t)>& visit, Need /*need*/)
{
  line(key, size == 0 ? "[]" : "");
  for (std::size_t i = 0; i < size; ++i)
  {
    Writer child(depth_ + 2);
    visit(child, i);
    child.yaml_[static_cast<std::size_t>(depth_) * 2 + 2] = '-';
    yaml_ += child.yaml_;
  }
}

void Writer::reject(const std::string& key, const std::string& remedy) const
{
  throw InputError("values to write", key, remedy);
}

}  // namespace endovascular_sim::yaml
