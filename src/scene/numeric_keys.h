#pragma once

#include <string>
#include <vector>

#include "yaml/reader.h"

namespace endovascular_sim::scene
{

/** Numeric keys of scenes, instruments and procedures, each once, in the order of the schema. */
std::vector<yaml::NumericKey> numericKeys();

/** Table of the numeric keys as Markdown: key, unit, usual and accepted values. docs/KEYS.md contains it. */
std::string numericKeysTable();

}  // namespace endovascular_sim::scene
