#include "common/xml/xml_depth.h"

#include <algorithm>

#include "common/error.h"

namespace endovascular_sim
{
namespace
{

constexpr auto kBlanks = " \t\r\n\v\f";

/** Scanner of the tags of an XML text. */
class TagScanner
{
public:
  TagScanner(std::string_view text, const std::string& file) : text_(text), file_(file) {}

  void scan()
  {
    while ((at_ = text_.find('<', at_)) != std::string_view::npos)
    {
      if (startsWith("<!--"))
        skipPast("-->");
      else if (startsWith("<![CDATA["))
        skipPast("]]>");
      else if (startsWith("</"))
      {
        depth_ -= depth_ > 0 ? 1 : 0;
        skipPast(">");
      }
      else if (at_ + 1 < text_.size() && isNameStart(text_[at_ + 1]))
        readStartTag();
      else
        skipPast(">");
    }
  }

private:
  static bool isNameStart(char c)
  {
    const auto u = static_cast<unsigned char>(c);
    return u >= 127 || (u >= 'a' && u <= 'z') || (u >= 'A' && u <= 'Z') || u == '_';
  }

  bool startsWith(std::string_view mark) const { return text_.substr(at_, mark.size()) == mark; }

  void skipPast(std::string_view mark)
  {
    const std::size_t found = text_.find(mark, at_);
    at_ = found == std::string_view::npos ? text_.size() : found + mark.size();
  }

  [[noreturn]] void refuse(std::size_t at, const std::string& reason) const
  {
    const auto end = text_.begin() + static_cast<std::ptrdiff_t>(std::min(at, text_.size()));
    throw InputError(file_, "line " + std::to_string(1 + std::count(text_.begin(), end, '\n')), reason);
  }

  void skipBlanks() { at_ = std::min(text_.find_first_not_of(kBlanks, at_), text_.size()); }

  /** Reads a start tag with its attributes, each a name and a value in quotes. */
  void readStartTag()
  {
    const std::size_t begin = at_;
    at_ = std::min(text_.find_first_of(" \t\r\n\v\f/>", at_), text_.size());
    for (skipBlanks(); at_ < text_.size(); skipBlanks())
    {
      if (startsWith("/>"))
        return;
      if (startsWith(">"))
      {
        if (++depth_ > kMaxXmlDepth)
          refuse(begin,
                 "elements are nested deeper than " + std::to_string(kMaxXmlDepth) + " levels; the file is damaged");
        return;
      }
      readAttribute();
    }
  }

  void readAttribute()
  {
    const std::size_t begin = at_;
    at_ = std::min(text_.find_first_of("= \t\r\n\v\f/>\"'", at_), text_.size());
    skipBlanks();
    if (!startsWith("="))
      refuse(begin, "is no XML: an attribute must be name=\"value\"; correct it");
    ++at_;
    skipBlanks();
    if (!startsWith("\"") && !startsWith("'"))
      refuse(begin, "is no XML: the value of an attribute must be in quotes; correct it");
    const std::size_t end = text_.find(text_[at_], at_ + 1);
    at_ = end == std::string_view::npos ? text_.size() : end + 1;
  }

  std::string_view text_;
  const std::string& file_;
  std::size_t at_ = 0;
  std::size_t depth_ = 0;
};

}  // namespace

void requireShallowXml(std::string_view text, const std::string& file)
{
  TagScanner(text, file).scan();
}

}  // namespace endovascular_sim
