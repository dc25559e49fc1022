#include <cmath>
#include <memory>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "common/error.h"
#include "common/units.h"
#include "session/session.h"

// Flow of blood in sessions: the same bits after save and load, pressure at catheters, loads on instruments.

namespace endovascular_sim::session
{
namespace
{

using units::kMillimetreOfMercury;

/** A wire and a catheter in the natural anatomy, with flow. */
std::shared_ptr<const World> catheterInTheAorta(const std::vector<std::string>& more = {})
{
  std::vector<std::string> overrides = {"flow=adult", "fluoroscopy=none"};
  overrides.insert(overrides.end(), more.begin(), more.end());
  return World::open("catheter", overrides);
}

std::string hashOf(const Session& session)
{
  return std::to_string(session.simulation().trajectoryHash());
}

TEST(BloodFlow, ContinuesFromASavedStateBitForBit)
{
  const auto world = catheterInTheAorta();
  Session whole(world), saved(world), loaded(world);
  const int before = 713, after = 400;  // within a step of the flow
  whole.step(before + after);
  saved.step(before);
  const std::string state = saved.save();
  saved.step(after);
  loaded.load(state);
  loaded.step(after);
  EXPECT_EQ(loaded.simulation().stateHash(), whole.simulation().stateHash());
  EXPECT_EQ(hashOf(saved), hashOf(whole)) << "saving changes nothing";
  EXPECT_EQ(loaded.observe().blood()->pressures, whole.observe().blood()->pressures);
  EXPECT_EQ(loaded.observe().pressure(1), whole.observe().pressure(1));
}

TEST(BloodFlow, BeginsAgainAfterAReset)
{
  const auto world = catheterInTheAorta();
  Session session(world);
  session.step(300);
  const std::string first = hashOf(session);
  const std::vector<double> pressures = session.observe().blood()->pressures;
  flow::FlowControls controls = session.flowControls();
  controls.heart_rate = 2.0;
  session.setFlowControls(controls);
  session.step(200);
  session.reset();
  session.step(300);
  EXPECT_EQ(hashOf(session), first);
  EXPECT_EQ(session.observe().blood()->pressures, pressures);
}

TEST(BloodFlow, IsMeasuredByACatheterInTheAorta)
{
  Session session(catheterInTheAorta({"instruments.0.drive.insertion.points=[[0, 0], [2, 0.4]]",
                                      "instruments.1.drive.insertion.points=[[0, 0], [2, 0], [4, 0.45]]"}));
  double low = 1e9, high = 0.0;
  session.step(5500);
  ASSERT_EQ(session.observe().branchName(1), "abdominal_aorta");
  for (int k = 0; k < 2000; ++k)
  {
    session.step();
    low = std::min(low, session.observe().pressure(1));
    high = std::max(high, session.observe().pressure(1));
  }
  EXPECT_GT(high, 100.0 * kMillimetreOfMercury);
  EXPECT_LT(high, 150.0 * kMillimetreOfMercury);
  EXPECT_GT(low, 55.0 * kMillimetreOfMercury);
  EXPECT_LT(low, 90.0 * kMillimetreOfMercury);
  EXPECT_TRUE(std::isnan(session.observe().pressure(0))) << "a wire has no lumen";
  EXPECT_NEAR(session.observe().blood()->means.readings[0], session.observe().blood()->means.root, 400.0);
}

TEST(BloodFlow, FollowsTheTeachersControls)
{
  Session session(catheterInTheAorta());
  session.step(2000);
  const double rest = session.observe().blood()->means.root;
  flow::FlowControls controls = session.flowControls();
  controls.mean_pressure *= 0.7;
  controls.heart_rate = 1.5;
  session.setFlowControls(controls);
  const std::uint32_t beats = session.observe().blood()->beats;
  session.step(10000);
  EXPECT_NEAR(session.observe().blood()->means.root, 0.7 * rest, 0.05 * rest);
  EXPECT_NEAR(session.observe().blood()->beats - beats, 15.0, 1.0);
  controls.heart_rate = 100.0;
  EXPECT_THROW(session.setFlowControls(controls), std::invalid_argument);
}

TEST(BloodFlow, MovesNothingInAStiffWireAndLeavesOtherScenesAlone)
{
  Session still(World::open("catheter", {"fluoroscopy=none"}));
  EXPECT_EQ(still.observe().blood(), nullptr);
  EXPECT_THROW(still.flowControls(), std::logic_error);
  Session flowing(catheterInTheAorta({"flow.drag=none"}));
  still.step(500);
  flowing.step(500);
  EXPECT_EQ(hashOf(still), hashOf(flowing)) << "without drag and balloons the blood does not act on instruments";
}

constexpr auto kAdenosine =
    "procedure={name: adenosine, steps: [{wait: 0.5, hyperaemia: true}, {wait: 0.3, hyperaemia: false}]}";

TEST(BloodFlow, BecomesHyperaemicByAStepOfTheScriptedOperator)
{
  Session session(catheterInTheAorta({kAdenosine}));
  session.step(400);
  EXPECT_TRUE(session.flowControls().hyperaemia);
  session.step(300);
  EXPECT_FALSE(session.flowControls().hyperaemia);
  while (!session.isOver())
    session.step();
  EXPECT_EQ(session.scriptedOperator()->progress(), procedure::Progress::kDone);
}

TEST(BloodFlow, OfAPersonsStepIsThatWhichThePersonSets)
{
  Session session(catheterInTheAorta({kAdenosine, "procedure.guided=true"}));
  session.step(2000);
  EXPECT_FALSE(session.flowControls().hyperaemia);
  EXPECT_EQ(session.scriptedOperator()->records().size(), 1U) << "waits for adenosine";
  flow::FlowControls controls = session.flowControls();
  controls.hyperaemia = true;
  session.setFlowControls(controls);
  session.step(1000);
  EXPECT_EQ(session.scriptedOperator()->records().size(), 2U);
}

TEST(BloodFlow, RefusesWhatAPatientOrASchemeCannotHave)
{
  const auto refusalOf = [](const std::vector<std::string>& overrides)
  {
    try
    {
      World::open("catheter", overrides);
    }
    catch (const InputError& error)
    {
      return std::string(error.what());
    }
    return std::string("accepted");
  };
  EXPECT_NE(refusalOf({"flow=child"}).find("no circulation \"child\"; known: adult"), std::string::npos);
  EXPECT_NE(refusalOf({"flow=adult", "flow.time_step=0.0025"}).find("flow.time_step"), std::string::npos);
  EXPECT_NE(refusalOf({"flow=adult", "flow.heart_rate=0.1"}).find("flow.heart_rate"), std::string::npos);
  EXPECT_NE(refusalOf({"flow=adult", "flow.circulation.outlets.decay=-1"}).find("flow.circulation.outlets.decay"),
            std::string::npos);
  EXPECT_NE(refusalOf({"flow=adult", "flow.circulation.outlets.territories.0.share=0.9"})
                .find("flow.circulation.outlets.territories"),
            std::string::npos);
  EXPECT_NE(refusalOf({"flow=adult", "loads.fluid_density=1060"}).find("loads.fluid_density"), std::string::npos);
  EXPECT_NE(refusalOf({"flow={}"}).find("flow.circulation"), std::string::npos);
}

}  // namespace
}  // namespace endovascular_sim::session
