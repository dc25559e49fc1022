#pragma once

#include <cstddef>
#include <string>

namespace endovascular_sim
{

/** Largest length of a name that plainNameOf() returns [bytes]. */
constexpr std::size_t kLongestPlainName = 100;

/** Name in any script that can be a part of a file name, from any text: characters beyond ASCII, letters, digits, `_`,
 *  `-` and `.`, in UTF-8. Other characters become `_`, and so do bytes that are no UTF-8. A valid name stays unchanged,
 *  e.g. `left_main`, `größe` or `冠状動脈`; an empty one becomes `_`. */
std::string plainNameOf(const std::string& text);

}  // namespace endovascular_sim
