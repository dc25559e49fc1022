#include "common/process/child_process.h"

#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <string>

namespace endovascular_sim
{
namespace
{

const std::string kNasty = "q'; touch \"PWNED\"; echo $HOME `id` '\n*";

TEST(ChildProcess, ReceivesEveryArgumentLiterally)
{
  EXPECT_EQ(runProgram({"/usr/bin/test", kNasty, "=", kNasty}), 0);
  EXPECT_EQ(runProgram({"/usr/bin/test", kNasty, "=", "another text"}), 1);
}

TEST(ChildProcess, CreatesAFileWhoseNameHoldsQuotes)
{
  const std::filesystem::path file = std::filesystem::temp_directory_path() / "O'Brien; touch PWNED";
  std::filesystem::remove(file);
  EXPECT_EQ(runProgram({"/usr/bin/touch", file.string()}), 0);
  EXPECT_TRUE(std::filesystem::exists(file));
  std::filesystem::remove(file);
}

TEST(ChildProcess, ReportsExitCodeSignalAndAMissingProgram)
{
  EXPECT_EQ(runProgram({"/bin/sh", "-c", "exit 7"}), 7);
  EXPECT_EQ(runProgram({"/bin/sh", "-c", "kill -9 $$"}), 128 + 9);
  EXPECT_EQ(runProgram({"/no/such/program"}), -1);
  EXPECT_EQ(runProgram({}), -1);
}

TEST(ChildProcess, EndsWithTheProcessThatStartedIt)
{
  std::array<int, 2> line{};  // every process below holds its other end open while it lives
  ASSERT_EQ(pipe(line.data()), 0);
  const pid_t middle = fork();
  if (middle == 0)
  {
    runProgram({"/bin/sh", "-c", "echo started >&" + std::to_string(line[1]) + "; exec sleep 1000"});
    _exit(0);
  }
  close(line[1]);
  char byte = 0;
  ASSERT_EQ(read(line[0], &byte, 1), 1);
  EXPECT_EQ(kill(middle, SIGKILL), 0);
  EXPECT_EQ(waitpid(middle, nullptr, 0), middle);
  while (read(line[0], &byte, 1) > 0)
  {
  }
  // The line has ended, so no process holds it.
  close(line[0]);
}

}  // namespace
}  // namespace endovascular_sim
