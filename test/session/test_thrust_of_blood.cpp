#include <memory>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "common/units.h"
#include "scene/scene_file.h"
#include "session/session.h"

// Thrust of the blood on an occluding balloon, at the hand.

namespace endovascular_sim::session
{
namespace
{

using units::kMillimetreOfMercury;

constexpr double kPi = 3.14159265358979323846;
constexpr double kRadius = 1.5e-3;   // of vessel and balloon [m]
constexpr double kPressure = 2.4e4;  // mean, such that more than 100 mmHg act on the balloon [Pa]
constexpr int kBeat = 857;           // steps of 1 ms at 70 beats per minute

/** Balloon of 3 mm, full from 0.5 s on, in a straight vessel of 3 mm without friction. */
std::shared_ptr<const World> occludedTube(const std::vector<std::string>& more = {})
{
  return World::make(scene::parseScene(R"(
duration: 60
vessel: {tube: {radius: 1.5e-3, pieces: [{length: 0.12}]}, friction: 0}
entry: {position: [0, 0, 0], direction: [0, 0, 1]}
instrument: {use: balloon_300_12_nc}
drive: {source: script, initial_insertion: 0.06, pressure: {points: [[0, 0], [0.5, 12.16e5]]}}
sampling: {kind: adaptive}
)",
                                       "occluded tube", more));
}

/** Means over a beat, after the circulation behind the balloon has emptied [Pa], [N]. */
struct Means
{
  double difference = 0.0;  ///< of the pressures before and behind the balloon
  double force = 0.0;       ///< on the hand, positive where the instrument is pushed out
};

Means meansOf(const std::shared_ptr<const World>& world)
{
  Session session(world);
  session.step(10000);
  const Eigen::Vector3d before(0, 0, 0.02), behind(0, 0, 0.1);
  Means means;
  for (int k = 0; k < kBeat; ++k)
  {
    session.step();
    const Observation& seen = session.observe();
    if (seen.blood() != nullptr)
      means.difference += (seen.bloodPressure(before) - seen.bloodPressure(behind)) / kBeat;
    means.force += seen.hand(0).force / kBeat;
  }
  return means;
}

TEST(ThrustOfBlood, OnAnOccludingBalloonOf3MillimetresIs94MillinewtonsAt100MillimetresOfMercury)
{
  const Means still = meansOf(occludedTube());
  const Means flowing = meansOf(occludedTube({"flow=adult", "flow.mean_pressure=" + std::to_string(kPressure)}));
  EXPECT_GT(flowing.difference, 100.0 * kMillimetreOfMercury);
  const double thrust = still.force - flowing.force;  // towards the tip
  EXPECT_NEAR(thrust, flowing.difference * kPi * kRadius * kRadius, 0.1 * thrust);
  EXPECT_NEAR(thrust * 100.0 * kMillimetreOfMercury / flowing.difference, 94e-3, 9.4e-3);
}

}  // namespace
}  // namespace endovascular_sim::session
