#include "common/text/plain_name.h"

#include <algorithm>

#include "common/text/one_line.h"

namespace endovascular_sim
{
namespace
{

bool isAscii(char c)
{
  return static_cast<unsigned char>(c) < 0x80;
}

bool isPlain(char c)
{
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_' || c == '-' || c == '.';
}

/** True for a byte of a character in UTF-8 after its first one. */
bool continuesCharacter(char c)
{
  return (static_cast<unsigned char>(c) & 0xc0U) == 0x80;
}

}  // namespace

std::string plainNameOf(const std::string& text)
{
  std::size_t length = std::min(text.size(), kLongestPlainName);
  while (length > 0 && length < text.size() && continuesCharacter(text[length]))
    --length;
  std::string name = text.substr(0, length);
  for (char& c : name)
    if (isAscii(c) && !isPlain(c))
      c = '_';
  if (!isOneLine(name))
    for (char& c : name)
      c = isAscii(c) ? c : '_';
  return name.empty() ? "_" : name;
}

}  // namespace endovascular_sim
