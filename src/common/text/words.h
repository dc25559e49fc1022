#pragma once

#include <string>
#include <vector>

namespace endovascular_sim
{

/** Words divided by ", ". */
std::string listed(const std::vector<std::string>& words);

/** Word of @p known nearest to @p word in edit distance; empty if none is close. */
std::string nearestWord(const std::string& word, const std::vector<std::string>& known);

/** Remedy for an unknown word: `did you mean "NEAREST"?`, or LABEL followed by all of @p known if none is close. */
std::string suggestion(const std::string& word, const std::vector<std::string>& known, const std::string& label);

/** Number of letters to insert, delete or replace that turn @p a into @p b. */
std::size_t editDistance(const std::string& a, const std::string& b);

}  // namespace endovascular_sim
