#include "common/text/plain_name.h"

#include <gtest/gtest.h>

namespace endovascular_sim
{
namespace
{

TEST(PlainName, KeepsLettersOfAllScripts)
{
  for (const std::string name : {"left_main", "größe", "冠状動脈", "аорта-2", "LAD.1"})
    EXPECT_EQ(plainNameOf(name), name);
}

TEST(PlainName, ReplacesWhatNoFileNameHolds)
{
  EXPECT_EQ(plainNameOf("Aorta ascendens – größe"), "Aorta_ascendens_–_größe");
  EXPECT_EQ(plainNameOf("a/b\\c:d\n\"e'"), "a_b_c_d__e_");
  EXPECT_EQ(plainNameOf(""), "_");
  EXPECT_EQ(plainNameOf("gr\xf6\xdf"), "gr__");  // Latin-1
}

TEST(PlainName, IsCutBetweenCharacters)
{
  std::string text = "x";
  for (int k = 0; k < 50; ++k)
    text += "脈";
  const std::string name = plainNameOf(text);
  EXPECT_EQ(name.size(), 100u);
  EXPECT_EQ(plainNameOf(name), name);
  EXPECT_EQ(plainNameOf("y" + text).size(), 98u);
}

}  // namespace
}  // namespace endovascular_sim
