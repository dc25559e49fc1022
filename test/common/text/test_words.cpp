#include "common/text/words.h"

#include <gtest/gtest.h>

namespace endovascular_sim
{
namespace
{

TEST(Words, OfAMisspellingTheNearestOneIsSuggested)
{
  const std::vector<std::string> known = {"density", "composition"};
  EXPECT_EQ(nearestWord("densty", known), "density");
  EXPECT_EQ(suggestion("densty", known, "known: "), "did you mean \"density\"?");
  EXPECT_EQ(suggestion("colour", known, "known: "), "known: density, composition");
  EXPECT_EQ(editDistance("kitten", "sitting"), 3U);
}

}  // namespace
}  // namespace endovascular_sim
