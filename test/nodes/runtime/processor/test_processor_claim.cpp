#include "nodes/runtime/processor/processor_claim.h"

#include <fcntl.h>
#include <signal.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstdlib>
#include <filesystem>

#include <gtest/gtest.h>

namespace endovascular_sim::nodes
{
namespace
{

class ProcessorClaimTest : public testing::Test
{
protected:
  ProcessorClaimTest() { std::filesystem::remove_all(folder_); }
  ~ProcessorClaimTest() override { std::filesystem::remove_all(folder_); }

  const std::string folder_ = testing::TempDir() + "/claims_" + std::to_string(getpid());
};

TEST_F(ProcessorClaimTest, TwoSessionsOnTwoProcessorsUseOneEach)
{
  const ProcessorClaim first("http://localhost:11311/", {0, 1}, folder_);
  const ProcessorClaim second("http://localhost:11312/", {0, 1}, folder_);
  EXPECT_EQ(first.choice().processor, 1);
  EXPECT_EQ(second.choice().processor, 0);
  EXPECT_EQ(second.choice().other_sessions, 0U);
  EXPECT_EQ(first.otherSessions(), 0U);
}

TEST_F(ProcessorClaimTest, ProcessesOfOneSessionShareItsProcessor)
{
  const ProcessorClaim rod("http://localhost:11311/", {0, 1}, folder_);
  const ProcessorClaim contact("http://localhost:11311/", {0, 1}, folder_);
  EXPECT_EQ(contact.choice().processor, rod.choice().processor);
  EXPECT_EQ(contact.choice().other_sessions, 0U);
}

TEST_F(ProcessorClaimTest, ReportsThatAnotherSessionUsesTheOnlyProcessor)
{
  const ProcessorClaim first("a", {1}, folder_);
  EXPECT_EQ(first.otherSessions(), 0U);
  const ProcessorClaim second("b", {1}, folder_);
  EXPECT_EQ(second.choice().other_sessions, 1U);
  EXPECT_EQ(first.otherSessions(), 1U);
}

TEST_F(ProcessorClaimTest, IsReleasedWhenItsProcessIsKilled)
{
  int ready[2];
  ASSERT_EQ(pipe(ready), 0);
  const pid_t child = fork();
  ASSERT_GE(child, 0);
  if (child == 0)
  {
    const ProcessorClaim claim("killed", {0, 1}, folder_);
    const char byte = 'r';
    if (write(ready[1], &byte, 1) == 1)
      pause();
    _exit(0);
  }
  char byte = 0;
  ASSERT_EQ(read(ready[0], &byte, 1), 1);
  EXPECT_EQ(ProcessorClaim("while it lives", {0, 1}, folder_).choice().processor, 0);
  kill(child, SIGKILL);
  waitpid(child, nullptr, 0);
  EXPECT_EQ(ProcessorClaim("afterwards", {0, 1}, folder_).choice().processor, 1);
  close(ready[0]);
  close(ready[1]);
}

TEST_F(ProcessorClaimTest, RunsWithoutAClaimWhileAnotherAccountHoldsTheLock)
{
  std::filesystem::create_directories(folder_);
  const int guard = open((folder_ + "/guard").c_str(), O_RDONLY | O_CREAT, 0644);
  ASSERT_GE(guard, 0);
  ASSERT_EQ(flock(guard, LOCK_EX), 0);
  {
    const ProcessorClaim claim("a", {0, 1}, folder_);  // would wait for ever
    EXPECT_EQ(claim.choice().processor, 1);
    EXPECT_FALSE(claim.isVisible());
    EXPECT_EQ(claim.otherSessions(), 0U);
  }
  close(guard);
  EXPECT_TRUE(ProcessorClaim("a", {0, 1}, folder_).isVisible());
}

TEST_F(ProcessorClaimTest, RunsWithoutAClaimWhereItsFileIsHeldOrAPipe)
{
  std::filesystem::create_directories(folder_);
  const int held = open((folder_ + "/1-a").c_str(), O_RDONLY | O_CREAT, 0644);
  ASSERT_EQ(flock(held, LOCK_EX), 0);
  EXPECT_FALSE(ProcessorClaim("a", {1}, folder_).isVisible());
  close(held);
  std::filesystem::remove(folder_ + "/guard");
  ASSERT_EQ(mkfifo((folder_ + "/guard").c_str(), 0644), 0);
  const ProcessorClaim claim("b", {1}, folder_);  // opening a pipe without a writer would wait for ever
  EXPECT_EQ(claim.choice().processor, 1);
}

TEST_F(ProcessorClaimTest, ChoosesWithoutAFolderThatItMayWrite)
{
  const ProcessorClaim claim("a", {0, 1}, "/proc/no_such_folder");
  EXPECT_EQ(claim.choice().processor, 1);
  EXPECT_FALSE(claim.isVisible());
}

}  // namespace
}  // namespace endovascular_sim::nodes
