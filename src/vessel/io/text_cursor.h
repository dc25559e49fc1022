#pragma once

#include <charconv>
#include <cstddef>
#include <string_view>

namespace endovascular_sim::vessel
{

/** Text without the byte order mark of UTF-8 that some editors put in front. */
inline std::string_view withoutByteOrderMark(std::string_view text)
{
  return text.substr(text.substr(0, 3) == "\xEF\xBB\xBF" ? 3 : 0);
}

/** Reads a text line by line and word by word, independent of the locale. Lines end with LF, CR LF or CR. */
class TextCursor
{
public:
  explicit TextCursor(std::string_view text) : rest_(text) {}

  /** Moves to the next line.
   *  @return false at the end of the text */
  bool nextLine()
  {
    if (rest_.empty())
      return false;
    const std::size_t end = rest_.find_first_of("\r\n");
    line_ = rest_.substr(0, end);
    if (end == std::string_view::npos)
      rest_ = {};
    else
      rest_.remove_prefix(end + (rest_.substr(end, 2) == "\r\n" ? 2 : 1));
    ++number_;
    return true;
  }

  /** Next word of the line; empty at its end. */
  std::string_view word()
  {
    const std::size_t begin = line_.find_first_not_of(" \t\v\f");
    if (begin == std::string_view::npos)
    {
      line_ = {};
      return {};
    }
    line_.remove_prefix(begin);
    const std::size_t end = line_.find_first_of(" \t\v\f");
    const std::string_view word = line_.substr(0, end);
    line_.remove_prefix(word.size());
    return word;
  }

  std::string_view restOfLine() const { return line_; }  ///< part of the line after the last word
  std::size_t lineNumber() const { return number_; }     ///< number of the present line, from 1
  std::string_view restOfText() const { return rest_; }  ///< text after the present line

private:
  std::string_view rest_, line_;
  std::size_t number_ = 0;
};

/** Converts a whole word to a number.
 *  @return false when the word is not a number of this type; infinities and NaN are numbers */
template <typename Number>
bool parseNumber(std::string_view word, Number& number)
{
  if (!word.empty() && word.front() == '+')
    word.remove_prefix(1);
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), number);
  return error == std::errc() && end == word.data() + word.size() && !word.empty();
}

}  // namespace endovascular_sim::vessel
