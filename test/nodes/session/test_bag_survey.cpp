#include "nodes/session/bag_survey.h"

#include <cstring>
#include <filesystem>
#include <fstream>
#include <functional>
#include <set>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <rosbag/bag.h>
#include <sensor_msgs/Image.h>
#include <topic_tools/shape_shifter.h>
#include <nlohmann/json.hpp>

#include "common/hash.h"
#include "endovascular_sim/RodStateVisual.h"
#include "endovascular_sim/SessionSample.h"
#include "nodes/session/recorded_simulation.h"
#include "nodes/session/session_bag.h"
#include "test/common/input_error_of.h"
#include "test/common/temporary_folder.h"
#include "test/fuzz/small_session_bag.h"

namespace endovascular_sim::nodes
{
namespace
{

constexpr std::uint64_t kSteps = 40;

/** What a recorded session lacks. */
struct Faults
{
  std::set<std::uint64_t> missing;     ///< steps
  bool swapped = false;                ///< true: steps 10 and 30 have changed places
  bool without_end = false;            ///< true: session/end is missing
  bool with_steps_of_another = false;  ///< true: drive/applied has other fields
  std::string added_to_scene;          ///< lines of the scene, with a right hash
};

/** Bag of a session with all that a display and a report need. */
class Survey : public testing::Test
{
protected:
  void record(const Faults& faults = {}) const
  {
    rosbag::Bag bag(file, rosbag::bagmode::Write);
    bag.setChunkThreshold(2048);
    fuzz::SmallSimulation small;
    writeBeginning(bag, small, faults);
    std::vector<DriveApplied> steps;
    for (std::uint64_t step = 0; step < kSteps; ++step)
      steps.push_back(nextStep(small, step));
    if (faults.swapped)
      std::swap(steps[10], steps[30]);
    for (const DriveApplied& step : steps)
      if (faults.missing.count(step.step) == 0)
        write(bag, step, faults.with_steps_of_another);
    SessionEnd end;
    end.steps = kSteps;
    if (!faults.without_end)
      fuzz::writeAt(bag, names::kSessionEnd, end);
    bag.close();
  }

  static void writeBeginning(rosbag::Bag& bag, const fuzz::SmallSimulation& small, const Faults& faults)
  {
    SessionInfo info;
    info.scene_name = "small";
    info.scene_yaml = small.scene.resolved_yaml + faults.added_to_scene;
    Hash64 hash;
    hash.add(info.scene_yaml);
    info.scene_hash = hash.value();
    info.time_step = small.scene.solver.time_step;
    info.physics_number = kPhysicsNumber;
    fuzz::writeAt(bag, names::kSessionInfo, info);
    fuzz::writeAt(bag, names::kRodStateVisual, RodStateVisual());
    fuzz::writeAt(bag, names::kSessionSample, SessionSample());
    sensor_msgs::Image picture;
    picture.data.assign(8000, 7);
    fuzz::writeAt(bag, names::kFluoroscopyImage, picture);
  }

  static DriveApplied nextStep(fuzz::SmallSimulation& small, std::uint64_t step)
  {
    const std::vector<drive::HandCommand> commands =
        simulation::commandsAt(small.scene, static_cast<double>(step + 1) * small.scene.solver.time_step);
    small.simulation.stepAll(commands);
    DriveApplied applied;
    applied.step = step;
    for (const drive::HandCommand& command : commands)
    {
      applied.insertion.push_back(command.insertion);
      applied.rotation.push_back(command.rotation);
      applied.pressure.push_back(command.pressure);
    }
    applied.state_hash = small.simulation.stateHash();
    return applied;
  }

  static void write(rosbag::Bag& bag, const DriveApplied& step, bool of_another_version)
  {
    if (!of_another_version)
    {
      fuzz::writeAt(bag, names::kDriveApplied, step);
      return;
    }
    topic_tools::ShapeShifter other;
    other.morph(std::string(32, '5'), "endovascular_sim/DriveApplied", "float64 other", "0");
    std::vector<std::uint8_t> bytes(8);
    ros::serialization::IStream in(bytes.data(), 8);
    other.read(in);
    bag.write(std::string("/") + names::kDriveApplied, ros::Time(1.0), other);
  }

  std::string content() const { return contentOf(file); }
  void replace(const std::string& bytes) const { std::ofstream(file, std::ios::binary | std::ios::trunc) << bytes; }

  /** Expects that a replay does not claim that every step is equal. */
  void expectNoCompleteReplay() const
  {
    try
    {
      const SessionBag recording = readSessionBag(file);
      RecordedSimulation session(recording, file);
      const ReplayOutcome outcome = nodes::replay(recording, session, true);
      EXPECT_TRUE(outcome.different > 0 || !outcome.incomplete.empty());
    }
    catch (const InputError& error)
    {
      EXPECT_NE(std::string(error.what()).find(file), std::string::npos) << error.what();
    }
  }

  TemporaryFolder folder;
  const std::string file = folder.file("session.bag");
};

TEST_F(Survey, OfACompleteBagNamesStepsAndUses)
{
  record();
  const BagSurvey survey = surveyBag(file);
  EXPECT_TRUE(survey.isComplete()) << textOf(survey);
  EXPECT_EQ(survey.steps, kSteps);
  EXPECT_EQ(survey.recomputed_to, kSteps - 1);
  EXPECT_EQ(survey.topics.at("/drive/applied").messages, kSteps);
  EXPECT_EQ(survey.topics.at("/drive/applied").type, "endovascular_sim/DriveApplied");
  const nlohmann::ordered_json json = toJson(survey);
  EXPECT_EQ(json["complete"], true);
  EXPECT_EQ(json["session"]["scene"], "small");
  EXPECT_NE(textOf(survey).find("recompute: every step"), std::string::npos) << textOf(survey);
}

TEST_F(Survey, OfABagThatIsCutOffNamesTheStepUpToWhichItCanBeComputed)
{
  record();
  const std::string whole = content();
  replace(whole.substr(0, whole.size() * 6 / 10));
  const BagSurvey survey = surveyBag(file);
  EXPECT_FALSE(survey.isComplete());
  EXPECT_TRUE(survey.isUsable());
  EXPECT_FALSE(survey.damage.empty());
  EXPECT_FALSE(survey.recorded_steps);
  ASSERT_TRUE(survey.recomputed_to);
  EXPECT_LT(*survey.recomputed_to, kSteps - 1);
  expectNoCompleteReplay();
}

TEST_F(Survey, OfABagWithoutEndIsNotComplete)
{
  Faults faults;
  faults.without_end = true;
  record(faults);
  const BagSurvey survey = surveyBag(file);
  EXPECT_FALSE(survey.isComplete());
  EXPECT_NE(survey.obstacle.find("has no end"), std::string::npos) << survey.obstacle;
  expectNoCompleteReplay();
}

TEST_F(Survey, OfABagWithAHoleNamesTheMissingSteps)
{
  Faults faults;
  faults.missing = {12, 13, 14, 20};
  record(faults);
  const BagSurvey survey = surveyBag(file);
  ASSERT_EQ(survey.gaps.size(), 2U);
  EXPECT_EQ(survey.gaps[0].first, 12U);
  EXPECT_EQ(survey.gaps[0].last, 14U);
  EXPECT_EQ(survey.recomputed_to, 11U);
  EXPECT_NE(textOf(survey).find("12 to 14 are missing"), std::string::npos) << textOf(survey);
  expectNoCompleteReplay();
}

TEST_F(Survey, OfABagWithZerosIsDamaged)
{
  record();
  const std::string whole = content();
  // Over the inputs of the steps, which follow the picture, and over the picture alone.
  const std::size_t picture = whole.find(std::string(4000, '\7'));
  ASSERT_NE(picture, std::string::npos);
  for (const std::size_t from : {picture + 10000, picture + 500})
  {
    std::string damaged = whole;
    std::memset(&damaged[from], 0, 3000);
    replace(damaged);
    const BagSurvey survey = surveyBag(file);
    if (from > picture + 8000)
    {
      EXPECT_FALSE(survey.isComplete());
      expectNoCompleteReplay();
    }
    else
    {
      EXPECT_EQ(survey.steps, kSteps) << "the inputs do not depend on the pictures";
    }
  }
}

TEST_F(Survey, OfSwappedStepsNamesTheOrder)
{
  Faults faults;
  faults.swapped = true;
  record(faults);
  const BagSurvey survey = surveyBag(file);
  EXPECT_EQ(survey.steps, kSteps);
  EXPECT_GT(survey.disordered_steps, 0U);
  EXPECT_NE(textOf(survey).find("in the wrong order"), std::string::npos) << textOf(survey);
}

TEST_F(Survey, OfAnotherVersionNamesTheTopic)
{
  Faults faults;
  faults.with_steps_of_another = true;
  record(faults);
  const BagSurvey survey = surveyBag(file);
  EXPECT_TRUE(survey.shows);
  EXPECT_FALSE(survey.recomputed_to);
  EXPECT_TRUE(survey.topics.at("/drive/applied").is_of_other_version);
  EXPECT_NE(survey.obstacle.find("fields of another version"), std::string::npos) << survey.obstacle;
}

TEST_F(Survey, OfASceneWithAnUnknownKeyNamesTheKey)
{
  Faults faults;
  faults.added_to_scene = "colour_of_the_wall: red\n";
  record(faults);
  const BagSurvey survey = surveyBag(file);
  EXPECT_FALSE(survey.recomputed_to);
  EXPECT_NE(survey.obstacle.find("colour_of_the_wall"), std::string::npos) << survey.obstacle;
  EXPECT_TRUE(survey.reports);
}

TEST_F(Survey, OfWhatIsNoBagSaysSo)
{
  for (const std::string bytes : {"", "#ROSBAG V1.2\n", "name: a scene\n"})
  {
    replace(bytes);
    const BagSurvey survey = surveyBag(file);
    EXPECT_FALSE(survey.isUsable()) << bytes;
    EXPECT_NE(survey.refusal.find(file), std::string::npos) << survey.refusal;
  }
  EXPECT_FALSE(surveyBag(folder.file("missing.bag")).isUsable());
}

TEST_F(Survey, OfARepairedCopyIsThatOfTheReadableMessages)
{
  record();
  const std::string whole = content();
  replace(whole.substr(0, whole.size() * 6 / 10));
  const std::string copy = folder.file("repaired.bag");
  const std::uint64_t messages = repairBag(file, copy);
  const BagSurvey before = surveyBag(file);
  const BagSurvey after = surveyBag(copy);
  EXPECT_TRUE(after.damage.empty()) << after.damage;
  EXPECT_EQ(after.steps, before.steps);
  EXPECT_FALSE(after.isComplete()) << "the end is still missing";
  std::uint64_t counted = 0;
  for (const auto& [name, topic] : after.topics)
    counted += topic.messages;
  EXPECT_EQ(counted, messages);
}

}  // namespace
}  // namespace endovascular_sim::nodes
