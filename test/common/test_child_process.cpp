#include "common/child_process.h"

#include <gtest/gtest.h>

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

}  // namespace
}  // namespace endovascular_sim
