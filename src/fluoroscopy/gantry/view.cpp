#include "fluoroscopy/gantry/view.h"

#include <cctype>
#include <charconv>
#include <cmath>

#include "common/units.h"

namespace endovascular_sim::fluoroscopy
{
namespace
{

using units::kDegree;
constexpr double kLargestPrimary = 180.0, kLargestSecondary = 90.0;  // [°]

struct NamedView
{
  const char* name;  // capital letters
  const char* spelling;
  double primary, secondary;  // [°]
};

constexpr NamedView kNamedViews[] = {
    {"AP", "AP", 0.0, 0.0}, {"LATERAL", "lateral", 90.0, 0.0}, {"SPIDER", "spider", 45.0, -30.0}};

/** Text without spaces, in capital letters. */
std::string normalised(const std::string& text)
{
  std::string result;
  for (const char c : text)
    if (std::isspace(static_cast<unsigned char>(c)) == 0)
      result += static_cast<char>(std::toupper(static_cast<unsigned char>(c)));
  return result;
}

/** Removes a prefix. @return false if the text begins otherwise */
bool take(std::string& text, const char* prefix)
{
  if (text.rfind(prefix, 0) != 0)
    return false;
  text.erase(0, std::char_traits<char>::length(prefix));
  return true;
}

/** Removes a number of degrees from 0 to @p largest. */
std::optional<double> takeDegrees(std::string& text, double largest)
{
  if (text.empty() || std::isdigit(static_cast<unsigned char>(text.front())) == 0)
    return std::nullopt;
  double value = 0.0;
  const auto end = std::from_chars(text.data(), text.data() + text.size(), value, std::chars_format::fixed);
  if (end.ec != std::errc() || value > largest)
    return std::nullopt;
  text.erase(0, static_cast<std::size_t>(end.ptr - text.data()));
  return value;
}

/** Removes an angle with one of two directions. @return 0 without either direction, nothing without a valid number */
std::optional<double> takeAngle(std::string& text, const char* positive, const char* negative, double largest)
{
  const bool is_positive = take(text, positive);
  if (!is_positive && !take(text, negative))
    return 0.0;
  const std::optional<double> degrees = takeDegrees(text, largest);
  if (!degrees)
    return std::nullopt;
  return is_positive ? *degrees : -*degrees;
}

}  // namespace

std::optional<View> parseView(const std::string& text)
{
  std::string rest = normalised(text);
  for (const NamedView& view : kNamedViews)
    if (rest == view.name)
      return View{view.primary * kDegree, view.secondary * kDegree};
  if (rest.empty())
    return std::nullopt;
  const bool ap = take(rest, "AP");
  const std::optional<double> primary = ap ? 0.0 : takeAngle(rest, "LAO", "RAO", kLargestPrimary);
  if (!primary)
    return std::nullopt;
  const std::optional<double> secondary = takeAngle(rest, "CRA", "CAU", kLargestSecondary);
  if (!secondary || !rest.empty())
    return std::nullopt;
  return View{*primary * kDegree, *secondary * kDegree};
}

std::string unknownView(const std::string& text)
{
  std::string names;
  for (const NamedView& view : kNamedViews)
    names += std::string(view.spelling) + ", ";
  return "unknown view '" + text + "'; known: " + names +
         "and angles in degrees such as 'LAO 40', 'CRA 30', 'RAO 30 CAU 20', 'LAO 45 CRA 25', 'AP CAU 30'";
}

}  // namespace endovascular_sim::fluoroscopy
