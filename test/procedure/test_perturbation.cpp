#include "procedure/perturbation.h"

#include <gtest/gtest.h>

#include "test/common/input_error_of.h"
#include "test/procedure/procedure_fixtures.h"

namespace endovascular_sim::procedure
{
namespace
{

const std::string kSteps =
    "    - {phase: In, advance: wire, until: {insertion: 0.1}}\n"
    "    - {wait: 1}\n"
    "    - {phase: Out, withdraw: wire, until: {by: 0.05}}\n";

TEST(Perturbation, LeavesTheSceneUnchangedForSeedZero)
{
  const scene::Scene scene = sceneWith(kSteps);
  const scene::Scene same = perturbed(scene, Spread(), 0);
  EXPECT_EQ(same.instruments[0].drive.initial_rotation, scene.instruments[0].drive.initial_rotation);
  EXPECT_EQ(same.procedure->hand.speed_scale, 1.0);
}

TEST(Perturbation, CoversItsSpreadWithoutExceedingIt)
{
  const scene::Scene scene = sceneWith(kSteps);
  double least = 1e9;
  double most = -1e9;
  for (std::uint64_t seed = 1; seed <= 200; ++seed)
  {
    const scene::Scene other = perturbed(scene, Spread(), seed);
    const double rotation = other.instruments[1].drive.initial_rotation;
    least = std::min(least, rotation);
    most = std::max(most, rotation);
    EXPECT_LE(std::abs(other.procedure->hand.speed_scale - 1.0), 0.2);
    EXPECT_LE(std::abs(other.procedure->steps[0].until.insertion - 0.1), 5e-3);
    EXPECT_GE(other.instruments[0].drive.initial_insertion, 0.0) << "an instrument in the introducer remains in it";
  }
  EXPECT_GE(least, -0.5);
  EXPECT_LE(most, 0.5);
  EXPECT_LT(least, -0.45);
  EXPECT_GT(most, 0.45);
}

TEST(Perturbation, IsReproducible)
{
  const scene::Scene scene = sceneWith(kSteps);
  EXPECT_EQ(perturbed(scene, Spread(), 7).instruments[0].drive.initial_rotation,
            perturbed(scene, Spread(), 7).instruments[0].drive.initial_rotation);
  EXPECT_NE(perturbed(scene, Spread(), 7).instruments[0].drive.initial_rotation,
            perturbed(scene, Spread(), 8).instruments[0].drive.initial_rotation);
}

TEST(Perturbation, EndsAProcedureAfterAPhase)
{
  EXPECT_EQ(endingWith(sceneWith(kSteps), "In").procedure->steps.size(), 2U)
      << "steps without a phase belong to the previous phase";
  EXPECT_EQ(endingWith(sceneWith(kSteps), "Out").procedure->steps.size(), 3U);
  const std::string message = inputErrorOf([&] { endingWith(sceneWith(kSteps), "Through"); });
  EXPECT_EQ(message, "test scene: procedure: has no phase 'Through'; known: In, Out");
}

}  // namespace
}  // namespace endovascular_sim::procedure
