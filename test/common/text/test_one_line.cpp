#include "common/text/one_line.h"

#include <gtest/gtest.h>

namespace endovascular_sim
{
namespace
{

TEST(OneLine, HoldsAnyPrintedCharacters)
{
  for (const char* text :
       {"", "trainee 7", "Stenose zu schnell überquert", "\xe6\xad\xa2\xe3\x82\x81", "\xf0\x9f\x91\x8d"})
    EXPECT_TRUE(isOneLine(text)) << text;
}

TEST(OneLine, HoldsNoControlCharacters)
{
  for (const char* text : {"a\nb", "\t", "\x7f", "\xc2\x85", "\xe2\x80\xa8"})
    EXPECT_FALSE(isOneLine(text)) << text;
}

TEST(OneLine, IsValidUtf8)
{
  for (const char* text : {"\xff", "\xc3", "\xc0\xaf", "\xe0\x80\x80", "\xed\xa0\x80", "\xf4\x90\x80\x80", "\xe6\xad"})
    EXPECT_FALSE(isOneLine(text));
}

TEST(OneLine, HasAtMostTwoHundredBytes)
{
  EXPECT_TRUE(isOneLine(std::string(kLongestLine, 'x')));
  EXPECT_FALSE(isOneLine(std::string(kLongestLine + 1, 'x')));
}

}  // namespace
}  // namespace endovascular_sim
