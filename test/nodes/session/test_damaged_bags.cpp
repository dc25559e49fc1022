#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <rosbag/bag.h>

#include "common/error.h"
#include "common/version.h"
#include "endovascular_sim/SessionEnd.h"
#include "nodes/conversions/vessel_conversions.h"
#include "nodes/runtime/ros_names.h"
#include "nodes/session/recorded_simulation.h"
#include "nodes/session/session_bag.h"
#include "test/common/random_damage.h"
#include "test/fuzz/fuzz_simulation.h"
#include "test/vessel/io/mesh_files.h"

// Damaged bags: a replay reports the damage, or its trajectory is that of the undamaged bag.

namespace endovascular_sim::nodes
{
namespace
{

constexpr int kCopies = 500;            // damaged copies of each compression
constexpr std::uint64_t kSteps = 3;     // steps of the session
constexpr std::uint32_t kChunk = 1024;  // size at which a chunk ends [B]

/** Results of a replay. */
enum class Result
{
  kRefused,   ///< InputError that names the bag
  kReported,  ///< steps differ, or are missing
  kEqual,     ///< every step compared, without a difference
};

/** Bag of a short session without a vessel in its scene. The bag also holds a mesh. */
class DamagedBag : public testing::TestWithParam<rosbag::CompressionType>
{
protected:
  DamagedBag()
    : file_((std::filesystem::temp_directory_path() / ("damaged_bag" + std::to_string(::getpid()) + ".bag")).string())
  {
  }
  ~DamagedBag() override { std::filesystem::remove(file_); }

  /** Records a session. @return content of the bag */
  std::string recorded()
  {
    rosbag::Bag bag(file_, rosbag::bagmode::Write);
    bag.setCompression(GetParam());
    bag.setChunkThreshold(kChunk);
    fuzz::SmallSimulation small;
    writeStart(bag, small);
    for (std::uint64_t step = 0; step < kSteps; ++step)
      writeStep(bag, small, step);
    SessionEnd end;
    end.steps = kSteps;
    write(bag, names::kSessionEnd, end);
    bag.close();
    trajectory_hash_ = small.simulation.trajectoryHash();
    std::ifstream stream(file_, std::ios::binary);
    return {std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>()};
  }

  /** Replays a bag with the given content. */
  Result replayOf(const std::string& content)
  {
    std::ofstream(file_, std::ios::binary | std::ios::trunc) << content;
    try
    {
      const SessionBag recording = readSessionBag(file_);
      RecordedSimulation session(recording, file_);
      const ReplayOutcome outcome = replay(recording, session, true);
      if (outcome.different > 0 || !outcome.incomplete.empty())
        return Result::kReported;
      EXPECT_EQ(outcome.compared, kSteps);
      EXPECT_EQ(session.simulation().trajectoryHash(), trajectory_hash_);
      return Result::kEqual;
    }
    catch (const InputError& error)
    {
      EXPECT_NE(std::string(error.what()).find(file_), std::string::npos) << error.what();
      return Result::kRefused;
    }
  }

private:
  template <typename Message>
  static void write(rosbag::Bag& bag, const char* topic, const Message& message)
  {
    bag.write(std::string("/") + topic, ros::Time(1.0), message);
  }

  static void writeStart(rosbag::Bag& bag, const fuzz::SmallSimulation& small)
  {
    VesselMesh mesh;
    toMessage(vessel::capsule(3, 1), mesh);
    SessionInfo info;
    info.scene_yaml = small.scene.resolved_yaml;
    info.scene_hash = small.scene.hash();
    info.mesh_hash = mesh.content_hash;
    info.time_step = small.scene.solver.time_step;
    info.physics_number = kPhysicsNumber;
    write(bag, names::kSessionInfo, info);
    write(bag, names::kVesselMesh, mesh);
  }

  static void writeStep(rosbag::Bag& bag, fuzz::SmallSimulation& small, std::uint64_t step)
  {
    const std::vector<simulation::HandCommand> commands =
        simulation::commandsAt(small.scene, static_cast<double>(step + 1) * small.scene.solver.time_step);
    small.simulation.stepAll(commands);
    DriveApplied applied;
    applied.step = step;
    for (const simulation::HandCommand& command : commands)
    {
      applied.insertion.push_back(command.insertion);
      applied.rotation.push_back(command.rotation);
      applied.pressure.push_back(command.pressure);
    }
    applied.state_hash = small.simulation.stateHash();
    write(bag, names::kDriveApplied, applied);
  }

  std::string file_;
  std::uint64_t trajectory_hash_ = 0;  ///< of the recorded session
};

TEST_P(DamagedBag, IsRefusedOrReportedOrReplaysTheSameTrajectory)
{
  const std::string content = recorded();
  ASSERT_EQ(replayOf(content), Result::kEqual);
  test::RandomDamage damage(1);
  int refused = 0;
  int reported = 0;
  for (int k = 0; k < kCopies; ++k)
  {
    SCOPED_TRACE("copy " + std::to_string(k));
    const Result result = replayOf(damage.of(content));
    refused += result == Result::kRefused;
    reported += result == Result::kReported;
  }
  EXPECT_GT(refused, 0);
  EXPECT_GT(reported, 0);
}

INSTANTIATE_TEST_SUITE_P(OfEachCompression, DamagedBag,
                         testing::Values(rosbag::compression::Uncompressed, rosbag::compression::LZ4));

}  // namespace
}  // namespace endovascular_sim::nodes
