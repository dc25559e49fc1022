#pragma once

#include <algorithm>
#include <array>
#include <string_view>

namespace endovascular_sim::simulation
{

/** First bytes of every saved state. */
constexpr std::array<char, 8> kStateMagic = {'E', 'V', 'S', 'S', 'T', 'A', 'T', 'E'};

/** True if bytes begin as those of a saved state. */
inline bool beginsAsState(std::string_view bytes)
{
  return bytes.size() >= kStateMagic.size() && std::equal(kStateMagic.begin(), kStateMagic.end(), bytes.begin());
}

}  // namespace endovascular_sim::simulation
