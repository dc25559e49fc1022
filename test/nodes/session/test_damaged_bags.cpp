#include <fstream>
#include <string>

#include <gtest/gtest.h>

#include "common/error.h"
#include "nodes/session/recorded_simulation.h"
#include "nodes/session/session_bag.h"
#include "test/common/random_damage.h"
#include "test/common/temporary_folder.h"
#include "test/fuzz/small_session_bag.h"

// Damaged bags: a replay reports the damage, or its trajectory is that of the undamaged bag.

namespace endovascular_sim::nodes
{
namespace
{

constexpr int kCopies = 500;  // damaged copies of each compression

/** Results of a replay. */
enum class Result
{
  kRefused,   ///< InputError that names the bag
  kReported,  ///< steps differ, or are missing
  kEqual,     ///< every step compared, without a difference
};

/** Bag of a short session. */
class DamagedBag : public testing::TestWithParam<rosbag::CompressionType>
{
protected:
  /** Records a session. @return content of the bag */
  std::string recorded()
  {
    trajectory_hash_ = fuzz::writeSmallSession(file_, GetParam());
    return contentOf(file_);
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
      EXPECT_EQ(outcome.compared, fuzz::kSessionSteps);
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
  TemporaryFolder folder_;
  const std::string file_ = folder_.file("damaged.bag");
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

// A seed that is refused would leave the bag behind its session info without fuzzing.
TEST(FuzzCorpus, HoldsABagThatReplays)
{
  const SessionBag session = readSessionBag(PROJECT_DIR "/test/fuzz/corpus/bag/session");
  EXPECT_EQ(session.steps.size(), fuzz::kSessionSteps) << "write the corpus again with make_corpus";
  EXPECT_EQ(session.recorded_steps, fuzz::kSessionSteps);
}

INSTANTIATE_TEST_SUITE_P(OfEachCompression, DamagedBag,
                         testing::Values(rosbag::compression::Uncompressed, rosbag::compression::LZ4));

}  // namespace
}  // namespace endovascular_sim::nodes
