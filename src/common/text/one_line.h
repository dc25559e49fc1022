#pragma once

#include <cstddef>
#include <string>

namespace endovascular_sim
{

/** Longest text of one line that users give: a remark or a subject [bytes]. */
constexpr std::size_t kLongestLine = 200;

/** Reports whether a text is valid UTF-8 in one line: no control characters, at most kLongestLine bytes. */
bool isOneLine(const std::string& text);

}  // namespace endovascular_sim
