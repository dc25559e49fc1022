#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace endovascular_sim
{

/** Maximum depth of the elements of an XML text. TinyXML reads elements recursively, so that a deep text ends the
 *  program. */
constexpr std::size_t kMaxXmlDepth = 64;

/** Checks the depth of an XML text before a library reads it. The markup is divided as TinyXML divides it.
 *  @param file name of the text in errors
 *  @throws InputError for elements nested deeper than kMaxXmlDepth, or an attribute without quotes */
void requireShallowXml(std::string_view text, const std::string& file);

}  // namespace endovascular_sim
