#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <string_view>

namespace endovascular_sim::simulation
{

/** Number of the format of saved states, incremented with every change of the saved data; common/releases.cpp lists it.
 */
constexpr std::uint32_t kStateFormat = 10;

/** First bytes of every saved state. */
constexpr std::array<char, 8> kStateMagic = {'E', 'V', 'S', 'S', 'T', 'A', 'T', 'E'};

/** True if bytes begin as those of a saved state. */
inline bool beginsAsState(std::string_view bytes)
{
  return bytes.size() >= kStateMagic.size() && std::equal(kStateMagic.begin(), kStateMagic.end(), bytes.begin());
}

}  // namespace endovascular_sim::simulation
