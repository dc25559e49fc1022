#include <gtest/gtest.h>

#include <cctype>
#include <string>

#include "benchmark/coaxial/jam_runs.h"

// Wire that is pushed through a catheter against a closed end.

namespace endovascular_sim::benchmark
{
namespace
{

class JammedStack : public testing::TestWithParam<JamCase>
{
};

TEST_P(JammedStack, TheHandsKeepToTheirGripsAndTheForceIsThatInARigidTube)
{
  const JamResult result = runJam(GetParam());
  EXPECT_LE(result.hand_ratio, 1.02);
  EXPECT_GE(result.hand_ratio, 0.95);  // the wire jams
  EXPECT_LE(result.layer_force, 1.02);
  EXPECT_LE(result.imbalance, 1e-9);
  EXPECT_LE(result.unexplained, 1e-2);
  EXPECT_EQ(result.rejected, 0);
  const JamSample& pushed = result.pushed;
  const double bound = 0.05 * pushed.wire + 5e-3;
  EXPECT_NEAR(pushed.wire, staticForceInRigidTube(GetParam(), pushed, JamMouth::kFree), bound);
  // Near the lock-up, 1 % of the load at the stop changes the force of the hand by more than 10 %.
  if (pushed.wire < 10.0 * pushed.tip_load)
  {
    EXPECT_NEAR(pushed.wire, staticForceInRigidTube(GetParam(), pushed, JamMouth::kLoaded), bound);
  }
}

std::string identifierOf(const testing::TestParamInfo<JamCase>& info)
{
  std::string name;
  for (const char letter : info.param.name)
    if (std::isalnum(static_cast<unsigned char>(letter)) != 0 || letter == '_')
      name += letter;
  return name;
}

INSTANTIATE_TEST_SUITE_P(Cases, JammedStack, testing::ValuesIn(jamCases()), identifierOf);

// The pushed wire is a second reference. Above 5 N its contacts chatter unless the steps are very short.
TEST(JammedStackReference, UpTo5NewtonsTheForceOfAPushedWireIsTheSame)
{
  for (const JamCase& at : jamCases())
  {
    if (at.friction == 0.0 || at.grip > 5.0)
      continue;
    const JamSample pushed = runJam(at).pushed;
    EXPECT_NEAR(pushed.wire, forceInRigidTube(at, pushed, JamReference()), 0.05 * pushed.wire + 5e-3) << at.name;
  }
}

}  // namespace
}  // namespace endovascular_sim::benchmark
