#pragma once

#include <cstddef>
#include <string>

#include <yaml-cpp/yaml.h>

namespace endovascular_sim::yaml
{

/** Maximum number of values of a YAML text. Those of an alias (`*name`) count at each of its uses. */
constexpr std::size_t kMaxYamlValues = 500000;

/** Maximum depth of lists and maps of a YAML text, through aliases too. */
constexpr std::size_t kMaxYamlDepth = 32;

/** Parses YAML text. All readers of YAML use this function.
 *  @param origin name of the text in errors
 *  @param where place in errors for a text without lines of its own, e.g. an override; empty: the line
 *  @throws InputError for a syntax error, a tab in the indentation, a second document, a merge key (`<<`), an anchor
 *          that contains itself, more than kMaxYamlValues values, or more than kMaxYamlDepth levels */
YAML::Node parseYamlText(const std::string& text, const std::string& origin, const std::string& where = "");

}  // namespace endovascular_sim::yaml
