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

TEST_P(JammedStack, NoHandBearsMoreThanItsGripAndTheForcesBalance)
{
  const JamResult result = runJam(GetParam());
  EXPECT_LE(result.hand_ratio, 1.02);
  EXPECT_GE(result.hand_ratio, 0.95);  // the wire jams
  EXPECT_LE(result.layer_force, 1.02);
  EXPECT_LE(result.imbalance, 1e-9);
  EXPECT_LE(result.unexplained, 1e-2);
  EXPECT_EQ(result.rejected, 0);
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

// `benchmark jam` runs all cases, above 5 N with steps of 25 µs in the reference.
TEST(JammedStackReference, TheHandForceIsThatInARigidTubeAlongTheRecordedAxis)
{
  for (const JamCase& at : jamCases())
  {
    if (at.friction == 0.0 || at.grip > 5.0)
      continue;
    const JamSample pushed = runJam(at).pushed;
    const double reference = forceInRigidTube(at, pushed, referenceFor(at));
    EXPECT_NEAR(pushed.wire, reference, 0.05 * reference + 5e-3) << at.name;
    const double still = staticForceInRigidTube(at, pushed);
    EXPECT_NEAR(pushed.wire, still, 0.05 * still + 5e-3) << at.name << ", static";
  }
}

}  // namespace
}  // namespace endovascular_sim::benchmark
