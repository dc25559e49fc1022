#include "nodes/session/former_names.h"

#include <fstream>
#include <map>
#include <optional>
#include <regex>
#include <sstream>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "common/error.h"
#include "common/version.h"
#include "endovascular_sim/ContactForceMap.h"
#include "endovascular_sim/ContactForces.h"
#include "endovascular_sim/ProcedureStep.h"
#include "endovascular_sim/RodStateVisual.h"
#include "endovascular_sim/SessionEnd.h"
#include "nodes/conversions/contact_force_conversions.h"
#include "nodes/player/bag_timeline.h"
#include "nodes/player/recorded_course.h"
#include "nodes/runtime/ros_names.h"
#include "nodes/session/bag_records.h"
#include "nodes/session/metrics_recorder.h"
#include "nodes/session/recorded_simulation.h"
#include "nodes/session/session_bag.h"
#include "scene/scene_file.h"

namespace endovascular_sim::nodes
{
namespace
{

/** Session of 0.2 s with a procedure and a balloon that widens a lesion, recorded by commit d3f544780a29, with its
 * metrics. */
constexpr auto kBag = TEST_DATA_DIR "/recorded_session/session.bag";
constexpr auto kMetrics = TEST_DATA_DIR "/recorded_session/metrics.json";

std::string textOf(const std::string& file)
{
  std::ostringstream text;
  text << std::ifstream(file).rdbuf();
  return text.str();
}

scene::Scene recordedScene()
{
  std::string yaml;
  readBagMessages(kBag,
                  [&yaml](const BagMessage& message)
                  {
                    if (message.topic == "/session/info")
                      yaml = message.read<SessionInfo>()->scene_yaml;
                  });
  return scene::parseRecordedScene(yaml, kBag);
}

TEST(FormerNames, OfTopicsArePresentOnesInAnyNamespace)
{
  EXPECT_EQ(presentTopic("/vessel/pressing"), "/vessel/balloon_load");
  EXPECT_EQ(presentTopic("/room/vessel/moved"), "/room/vessel/wall_displacement");
  EXPECT_EQ(presentTopic("/vessel/mesh"), "/vessel/mesh");
  EXPECT_EQ(presentTopic("/my_vessel/moved_on"), "/my_vessel/moved_on");
}

TEST(FormerNames, OfFieldsArePresentOnesWithoutComments)
{
  EXPECT_EQ(presentFields("# Text\nuint32 new_tries # count\n\nfloat64 time\n"), "uint32 retries\nfloat64 time\n");
  EXPECT_NE(presentFields("uint32 time\n"), presentFields("float64 time\n"));
}

TEST(BagOfAFormerVersion, IsReplayedBitForBitAsLongAsThePhysicsIsItsOwn)
{
  try
  {
    const SessionBag recording = readSessionBag(kBag);
    RecordedSimulation session(recording, kBag);
    const ReplayOutcome outcome = replay(recording, session, false);
    EXPECT_EQ(outcome.compared, 200U);
    EXPECT_EQ(outcome.different, 0U);
    EXPECT_EQ(outcome.incomplete, "");
    EXPECT_NE(session.session().wall().vertices, session.session().world().vessel()->mesh.vertices);
  }
  catch (const InputError& error)
  {
    EXPECT_NE(kPhysicsNumber, 7) << error.what();
    EXPECT_NE(std::string(error.what()).find("has physics 7"), std::string::npos) << error.what();
  }
}

TEST(BagOfAFormerVersion, IsShownByThePlayerWithTheTypesOfThisVersion)
{
  const BagTimeline timeline({kBag});
  std::map<std::string, std::string> shown;
  for (const RecordedTopic& topic : timeline.topics())
    shown[topic.name] = topic.md5sum;
  for (const auto& [topic, md5] :
       {std::pair("/session/info", ros::message_traits::MD5Sum<SessionInfo>::value()),
        std::pair("/vessel/mesh", ros::message_traits::MD5Sum<VesselMesh>::value()),
        std::pair("/vessel/centreline", ros::message_traits::MD5Sum<VesselCentreline>::value()),
        std::pair("/vessel/wall_displacement", ros::message_traits::MD5Sum<WallDisplacement>::value()),
        std::pair("/rod/state_visual", ros::message_traits::MD5Sum<RodStateVisual>::value()),
        std::pair("/treatment/state_visual", ros::message_traits::MD5Sum<TreatmentVisual>::value()),
        std::pair("/procedure/step", ros::message_traits::MD5Sum<ProcedureStep>::value()),
        std::pair("/contact/forces", ros::message_traits::MD5Sum<ContactForces>::value()),
        std::pair("/contact/force_map", ros::message_traits::MD5Sum<ContactForceMap>::value())})
    EXPECT_EQ(shown[topic], md5) << topic;
  EXPECT_EQ(timeline.states().size(), 2U);
  EXPECT_FALSE(RecordedCourse(timeline).chapters().empty());
}

TEST(BagOfAFormerVersion, IsReportedWithTheMetricsOfItsSession)
{
  MetricsRecorder metrics(recordedScene(), 200);
  std::optional<results::WallForceSummary> forces;
  int displacements = 0;
  int steps = 0;
  const auto isA = [](const BagMessage& message, const char* topic)
  { return message.topic == std::string("/") + topic; };
  readBagMessages(kBag,
                  [&](const BagMessage& message)
                  {
                    if (isA(message, names::kVesselMesh))
                      metrics.add(*message.read<VesselMesh>());
                    else if (isA(message, names::kVesselCentreline))
                      metrics.add(*message.read<VesselCentreline>());
                    else if (isA(message, names::kDriveApplied))
                      metrics.add(*message.read<DriveApplied>());
                    else if (isA(message, names::kSessionSample))
                      metrics.add(*message.read<SessionSample>());
                    else if (isA(message, names::kTreatmentVisual))
                      metrics.add(*message.read<TreatmentVisual>());
                    else if (isA(message, names::kContactForceMap))
                      forces = summaryFromMessage(*message.read<ContactForceMap>());
                    else if (isA(message, names::kWallDisplacement) && message.is<WallDisplacement>())
                    {
                      metrics.add(*message.read<WallDisplacement>());
                      ++displacements;
                    }
                    else if (isA(message, names::kProcedureStep) && message.is<ProcedureStep>())
                    {
                      metrics.add(*message.read<ProcedureStep>());
                      ++steps;
                    }
                  });
  EXPECT_EQ(displacements, 13);
  EXPECT_EQ(steps, 4);
  const std::string folder = testing::TempDir();
  metrics.write(folder, forces ? &*forces : nullptr);
  const std::string recorded = std::regex_replace(textOf(kMetrics), std::regex("new_tries"), "retries");
  EXPECT_EQ(textOf(folder + "/metrics.json"), recorded);
}

TEST(FormerFields, AreTheFirstOnesOfAPresentDefinition)
{
  const std::string present = "# text\nuint64 step\nfloat64 time # s\n====\nMSG: a/B\nint8 c\n";
  EXPECT_TRUE(hasFirstFields("uint64 step\n", present));
  EXPECT_TRUE(hasFirstFields("uint64 step\nfloat64 time\n====\nMSG: a/B\nint8 c\n", present));
  EXPECT_FALSE(hasFirstFields("float64 time\n", present));
  EXPECT_FALSE(hasFirstFields("", present));
  EXPECT_FALSE(hasFirstFields("uint64 step\n====\nMSG: a/B\nint16 c\n", present));
  EXPECT_FALSE(hasFirstFields(present + "int8 d\n", "uint64 step\n"));
}

TEST(FormerFields, AreReadAndLaterOnesKeepTheirInitialValues)
{
  BagMessage message;
  message.definition =
      "std_msgs/Header header\nuint64 steps\n====\nMSG: std_msgs/Header\nuint32 seq\ntime stamp\nstring frame_id\n";
  std::vector<std::uint8_t> bytes(24, 0);
  bytes[16] = 7;
  message.data = bytes.data();
  message.size = static_cast<std::uint32_t>(bytes.size());
  ASSERT_TRUE(message.is<SessionEnd>());
  EXPECT_EQ(message.read<SessionEnd>()->steps, 7U);
  EXPECT_EQ(message.read<SessionEnd>()->step_limit, 0U);
  message.size = 20;  // within a field
  EXPECT_THROW(message.read<SessionEnd>(), ros::Exception);
}

}  // namespace
}  // namespace endovascular_sim::nodes
