#include "common/text/one_line.h"

namespace endovascular_sim
{
namespace
{

/** Length of the UTF-8 character that a byte begins, 0 for a byte that begins none. */
std::size_t lengthOf(unsigned char first)
{
  if (first < 0x80)
    return 1;
  if (first >= 0xc2 && first < 0xe0)
    return 2;
  if (first >= 0xe0 && first < 0xf0)
    return 3;
  return first >= 0xf0 && first < 0xf5 ? 4 : 0;
}

/** Code point of a character.
 *  @pre all of its bytes are there */
unsigned long codeOf(const std::string& text, std::size_t at, std::size_t length)
{
  const auto first = static_cast<unsigned char>(text[at]);
  unsigned long code = length == 1 ? first : first & (0xffU >> (length + 1));
  for (std::size_t k = 1; k < length; ++k)
  {
    const auto next = static_cast<unsigned char>(text[at + k]);
    if ((next & 0xc0U) != 0x80)
      return 0;
    code = (code << 6U) | (next & 0x3fU);
  }
  return code;
}

/** Reports whether a code point is shown, and is written with its shortest length. */
bool isShown(unsigned long code, std::size_t length)
{
  const bool is_control = code < 0x20 || (code >= 0x7f && code < 0xa0) || code == 0x2028 || code == 0x2029;
  const bool is_surrogate = code >= 0xd800 && code < 0xe000;
  const bool is_too_long = (length == 3 && code < 0x800) || (length == 4 && (code < 0x10000 || code > 0x10ffff));
  return !is_control && !is_surrogate && !is_too_long;
}

}  // namespace

bool isOneLine(const std::string& text)
{
  if (text.size() > kLongestLine)
    return false;
  for (std::size_t at = 0; at < text.size();)
  {
    const std::size_t length = lengthOf(static_cast<unsigned char>(text[at]));
    if (length == 0 || at + length > text.size() || !isShown(codeOf(text, at, length), length))
      return false;
    at += length;
  }
  return true;
}

}  // namespace endovascular_sim
