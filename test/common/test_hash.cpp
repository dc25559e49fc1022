#include "common/hash.h"

#include <gtest/gtest.h>

namespace endovascular_sim
{
namespace
{

TEST(Hash64, DependsOnTheOrderOfItsWords)
{
  Hash64 a;
  a.add(1.0);
  a.add(2.0);
  Hash64 b;
  b.add(2.0);
  b.add(1.0);
  EXPECT_NE(a.value(), b.value());
}

TEST(Hash64, DistinguishesPlusZeroFromMinusZero)
{
  Hash64 a;
  a.add(0.0);
  Hash64 b;
  b.add(-0.0);
  EXPECT_NE(a.value(), b.value());
}

TEST(Hash64, DependsOnTheBoundaryBetweenAdjacentTexts)
{
  Hash64 a;
  a.add(std::string("ab"));
  a.add(std::string("c"));
  Hash64 b;
  b.add(std::string("a"));
  b.add(std::string("bc"));
  EXPECT_NE(a.value(), b.value());
}

TEST(Hash64, WritesSixteenHexadecimalDigits)
{
  EXPECT_EQ(Hash64::toHex(0x00ff12ULL), "000000000000ff12");
}

TEST(Hash64, IsEqualOnAllMachinesAndVersions)
{
  Hash64 hash;
  hash.add(0.1);
  hash.add(std::string("guidewire"));
  EXPECT_EQ(hash.hex(), "fd87bde0dbfd3cbc");
}

}  // namespace
}  // namespace endovascular_sim
