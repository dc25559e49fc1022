#include <memory>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "scene/scene_file.h"
#include "session/session.h"
#include "test/common/input_error_of.h"

// Motion of the patient in sessions: place in the vessel, controls, saved states, waits of the scripted operator.

namespace endovascular_sim::session
{
namespace
{

/** A wire and a catheter in the natural anatomy, in a moving patient. */
std::shared_ptr<const World> catheterInAPatient(const std::vector<std::string>& more = {})
{
  std::vector<std::string> overrides = {"motion=adult", "fluoroscopy=none"};
  overrides.insert(overrides.end(), more.begin(), more.end());
  return World::open("catheter", overrides);
}

std::string refusalOf(const std::vector<std::string>& more)
{
  return inputErrorOf([&] { catheterInAPatient(more)->motion(); });
}

/** Point of the patient that moves: the ostium of the left coronary artery [m]. */
Eigen::Vector3d ostium(const World& world)
{
  for (const vessel::CentrelineBranch& branch : world.vessel()->centreline.branches)
    if (branch.name == "left_main")
      return branch.points.front();
  throw std::logic_error("no left main artery");
}

TEST(PatientMotion, AdvancesWithEveryStepFromRest)
{
  Session session(catheterInAPatient());
  const motion::MovingPatient& patient = *session.observe().motion();
  const Eigen::Vector3d rest = ostium(session.world());
  EXPECT_EQ(patient.map().position(rest), rest);
  session.step(300);
  EXPECT_NEAR(patient.heart().phase(), 0.3 * 1.1667, 1e-12);
  EXPECT_NEAR(patient.breath().phase(), 0.3 * 0.25, 1e-12);
  EXPECT_GT((patient.map().position(rest) - rest).norm(), 5e-3);
  EXPECT_LT((patient.map().pullBack(patient.map().position(rest)) - rest).norm(), 1e-12);
  session.reset();
  EXPECT_EQ(session.observe().motion()->map().position(rest), rest);
}

TEST(PatientMotion, BeginsWithTheRatesOfTheScene)
{
  Session session(catheterInAPatient({"motion.heart_rate=2", "motion.breathing_rate=0.5", "motion.breath_held=true"}));
  session.step(200);
  EXPECT_NEAR(session.observe().motion()->heart().phase(), 0.4, 1e-12) << "from the first beat on";
  EXPECT_EQ(session.observe().motion()->diaphragm(), 0.0);
  const motion::MotionControls controls = session.motionControls();
  EXPECT_EQ(controls.heart_rate, 2.0);
  EXPECT_EQ(controls.breathing_rate, 0.5);
  EXPECT_TRUE(controls.breath_held);
}

TEST(PatientMotion, IsAbsentInOtherScenes)
{
  Session session(World::open("tube"));
  EXPECT_EQ(session.observe().motion(), nullptr);
  EXPECT_EQ(session.simulation().motion(), nullptr);
  EXPECT_THROW(session.motionControls(), std::logic_error);
  EXPECT_THROW(session.setMotionControls({1.0, 0.2, false}), std::logic_error);
  EXPECT_THROW(session.world().motion(), std::logic_error);
}

TEST(PatientMotion, FollowsTheTeachersControls)
{
  Session session(catheterInAPatient());
  session.step(100);
  session.setMotionControls({2.0, 0.5, false});
  session.step(100);
  EXPECT_EQ(session.observe().motion()->heart().rate(), 1.1667) << "until the end of the beat";
  session.step(800);
  EXPECT_EQ(session.observe().motion()->heart().rate(), 2.0);
  EXPECT_EQ(session.observe().motion()->breath().rate(), 0.25);
  for (const motion::MotionControls& refused :
       {motion::MotionControls{0.0, 0.25, false}, motion::MotionControls{400.0 / 60.0, 0.25, false},
        motion::MotionControls{1.0, 0.0, false}, motion::MotionControls{1.0, 400.0 / 60.0, false}})
    EXPECT_THROW(session.setMotionControls(refused), std::invalid_argument);
  EXPECT_EQ(session.motionControls().heart_rate, 2.0) << "a refused call changes nothing";
}

TEST(PatientMotion, WithFlowTakesNoOtherHeartRate)
{
  Session session(catheterInAPatient({"flow=adult"}));
  motion::MotionControls controls = session.motionControls();
  controls.breath_held = true;
  session.setMotionControls(controls);
  EXPECT_TRUE(session.motionControls().breath_held);
  controls.heart_rate = 2.0;
  EXPECT_NE(session.refusalOf(controls).find("the flow, which drives the heart"), std::string::npos);
  EXPECT_THROW(session.setMotionControls(controls), std::invalid_argument);
  flow::FlowControls flow = session.flowControls();
  flow.heart_rate = 0.0;  // arrest
  session.setFlowControls(flow);
  session.step(100);
  controls = session.motionControls();
  controls.breath_held = false;
  session.setMotionControls(controls);
  EXPECT_FALSE(session.motionControls().breath_held);
}

TEST(PatientMotion, ContinuesFromASavedStateBitForBit)
{
  const auto world = catheterInAPatient();
  Session whole(world), loaded(world);
  whole.step(200);
  whole.setMotionControls({2.0, 0.4, true});
  whole.step(513);
  const std::string state = whole.save();
  whole.step(400);
  loaded.load(state);
  EXPECT_EQ(loaded.motionControls(), (motion::MotionControls{2.0, 0.4, true}));
  loaded.step(400);
  EXPECT_EQ(loaded.simulation().trajectoryHash(), whole.simulation().trajectoryHash());
  const Eigen::Vector3d rest = ostium(*world);
  EXPECT_EQ(loaded.observe().motion()->map().position(rest), whole.observe().motion()->map().position(rest));
  EXPECT_EQ(loaded.observe().motion()->map().velocity(rest), whole.observe().motion()->map().velocity(rest));
}

TEST(PatientMotion, IsRefusedWhereTheVesselHasNoHeart)
{
  EXPECT_NE(refusalOf({"motion.patient.region.left_ostium=left_mian"})
                .find("motion.patient.region.left_ostium: the vessel has no branch \"left_mian\""),
            std::string::npos);
  const std::string fork = inputErrorOf(
      [] {
        Session(World::open("fork", {"motion=adult", "fluoroscopy=none", "sampling={kind: adaptive}"}));
      });
  EXPECT_NE(fork.find("motion.patient.region.left_ostium"), std::string::npos) << fork;
  EXPECT_NE(fork.find("use a vessel with named coronary arteries"), std::string::npos) << fork;
}

TEST(PatientMotion, IsRefusedWhereItFoldsSpace)
{
  const std::string folds =
      refusalOf({"motion.patient.heart.apex_rotation=0.7", "motion.patient.heart.base_rotation=-0.7",
                 "motion.patient.heart.radial_shortening=0.4"});
  EXPECT_NE(folds.find("motion.patient.heart: the motion folds space"), std::string::npos) << folds;
  EXPECT_NE(folds.find("give smaller displacements"), std::string::npos) << folds;
}

TEST(PatientMotion, IsRefusedWhereItReachesTheIntroducer)
{
  // A fade around the introducer of the groin, with no fixed branches.
  const Eigen::Vector3d entry = catheterInAPatient()->entry().position;
  const std::string centre =
      "[" + std::to_string(entry.x() + 0.1) + ", " + std::to_string(entry.y()) + ", " + std::to_string(entry.z()) + "]";
  // A shift alone: the other motions grow with the distance from the heart.
  const std::vector<std::string> around = {"motion.patient.region.fixed=[]",
                                           "motion.patient.region.centre=" + centre,
                                           "motion.patient.heart.base_displacement=0",
                                           "motion.patient.heart.radial_shortening=0",
                                           "motion.patient.heart.base_rotation=0",
                                           "motion.patient.heart.apex_rotation=0",
                                           "motion.patient.breathing.rotation=[0, 0, 0]"};
  const auto withCore = [&](const std::string& core)
  {
    std::vector<std::string> overrides = around;
    overrides.push_back("motion.patient.region.core=" + core);
    return refusalOf(overrides);
  };
  EXPECT_NE(withCore("0.06").find("entry: the introducer is 100 mm from"), std::string::npos) << withCore("0.06");
  EXPECT_NE(withCore("0.06").find("or remove motion"), std::string::npos);
  EXPECT_EQ(withCore("0.02"), "") << "20 mm away";
}

TEST(PatientMotion, AWaitHoldsTheBreathAndWaitsForItAndForDiastole)
{
  Session session(
      catheterInAPatient({"procedure={steps: [{wait: 0.5}, {wait: 0.2, breath: hold, until: diastole}, {wait: 0.3}, "
                          "{wait: 0.2, breath: free}]}"}));
  const motion::MovingPatient& patient = *session.observe().motion();
  session.step(600);
  EXPECT_TRUE(session.motionControls().breath_held) << "asked for with the second step";
  EXPECT_FALSE(patient.breath().standing());
  while (session.scriptedOperator()->records().size() < 3 && !session.isOver())
    session.step();
  EXPECT_TRUE(patient.breath().standing());
  EXPECT_GE(session.observe().time(), 4.0) << "the end of the first breath";
  EXPECT_FALSE(patient.systole());
  const double systole = patient.motion().settings().heart.systolicShare(patient.heart().rate());
  EXPECT_GE(patient.heart().phase(), systole + (1.0 - systole) / 3.0);
  EXPECT_LT(patient.heart().phase(), systole + 0.76 * (1.0 - systole));
  session.step(150);
  EXPECT_TRUE(session.motionControls().breath_held) << "until a step lets it go";
  while (!session.isOver())
    session.step();
  EXPECT_EQ(session.scriptedOperator()->progress(), procedure::Progress::kDone);
  EXPECT_FALSE(session.motionControls().breath_held);
  EXPECT_EQ(session.scriptedOperator()->records()[1].name, "wait 0.2 s, breath held, until diastole");
}

TEST(PatientMotion, ThePhaseOfAFastHeartIsNotWaitedFor)
{
  Session session(catheterInAPatient({"motion.heart_rate=5", "procedure={steps: [{wait: 0.2, until: diastole}]}"}));
  session.step(400);
  EXPECT_EQ(session.scriptedOperator()->progress(), procedure::Progress::kDone);
}

TEST(PatientMotion, APersonsWaitCountsWhileTheBreathIsHeld)
{
  Session session(catheterInAPatient({"procedure={guided: true, steps: [{wait: 0.3, breath: hold}, {wait: 0.1}]}"}));
  session.step(1000);
  EXPECT_FALSE(session.motionControls().breath_held) << "a person asks for it";
  EXPECT_EQ(session.scriptedOperator()->records().size(), 1U);
  motion::MotionControls controls = session.motionControls();
  controls.breath_held = true;
  session.setMotionControls(controls);
  session.step(500);
  EXPECT_EQ(session.scriptedOperator()->records().size(), 2U);
}

}  // namespace
}  // namespace endovascular_sim::session
