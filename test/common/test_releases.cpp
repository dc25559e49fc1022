#include "common/releases.h"

#include <gtest/gtest.h>

#include "common/version.h"

namespace endovascular_sim
{
namespace
{

const std::vector<Release> kSome = {{"1.0.0", 3, 5}, {"1.1.0", 4, 5}, {"1.2.0", 4, 6}};

TEST(Releases, EndWithThisVersionAndItsPhysics)
{
  ASSERT_FALSE(releases().empty());
  EXPECT_STREQ(releases().back().version, version());
  EXPECT_EQ(releases().back().physics, kPhysicsNumber);
}

TEST(Releases, OfAPhysicsNumberAreTheNewestOnes)
{
  EXPECT_EQ(releaseOfPhysics(3, kSome), "endovascular_sim 1.0.0");
  EXPECT_EQ(releaseOfPhysics(4, kSome), "endovascular_sim 1.2.0");
  EXPECT_EQ(releaseOfPhysics(5, kSome), "");
}

TEST(Releases, OfAStateAgreeInFormatAndPhysics)
{
  EXPECT_EQ(releaseOfState(5, 3, kSome), "endovascular_sim 1.0.0");
  EXPECT_EQ(releaseOfState(5, 0, kSome), "endovascular_sim 1.1.0");
  EXPECT_EQ(releaseOfState(6, 3, kSome), "");
}

TEST(Releases, OfAFormerKeyAreNamedWithItsSuccessor)
{
  const std::vector<FormerKey> keys = {{"drive.pace", "1.0.0", "drive.speed"}};
  EXPECT_EQ(remedyOfFormerKey("drive.pace", keys),
            "is a key of scenes of endovascular_sim 1.0.0, which reads it; use drive.speed");
  EXPECT_EQ(remedyOfFormerKey("drive.speed", keys), "");
}

}  // namespace
}  // namespace endovascular_sim
