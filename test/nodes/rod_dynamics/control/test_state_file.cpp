#include "nodes/rod_dynamics/control/state_file.h"

#include <sys/stat.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <iterator>

#include <gtest/gtest.h>

#include "test/common/input_error_of.h"
#include "test/common/temporary_folder.h"

namespace endovascular_sim::nodes
{
namespace
{

namespace fs = std::filesystem;

const std::string kState = "EVSSTATE and the bytes of a state";

void write(const fs::path& file, const std::string& text)
{
  std::ofstream(file, std::ios::binary) << text;
}

class StateFileTest : public testing::Test
{
protected:
  StateFileTest() { fs::create_directories(folder_ / "states"); }

  const TemporaryFolder temporary_;
  const fs::path& folder_ = temporary_.path();
};

TEST_F(StateFileTest, IsWrittenAndReadAndReplacesAnEarlierState)
{
  const std::string file = folder_ / "a.state";
  EXPECT_EQ(writeStateFile(file, kState), file);
  EXPECT_EQ(writeStateFile(file, kState + " again"), file);
  EXPECT_EQ(readStateFile(file), kState + " again");
  EXPECT_EQ(std::distance(fs::directory_iterator(folder_), fs::directory_iterator()), 2) << "no other file is left";
}

TEST_F(StateFileTest, DoesNotReplaceAFileThatIsNoState)
{
  const fs::path file = folder_ / "thesis.tex";
  write(file, "years of work");
  EXPECT_NE(inputErrorOf([&] { writeStateFile(file, kState); }).find("is no saved state"), std::string::npos);
  EXPECT_EQ(contentOf(file), "years of work");
  write(file, "");
  EXPECT_NE(inputErrorOf([&] { writeStateFile(file, kState); }), "") << "an empty file";
}

TEST_F(StateFileTest, DoesNotFollowALinkAtItsName)
{
  write(folder_ / "target", kState);
  fs::create_symlink(folder_ / "target", folder_ / "link");
  EXPECT_NE(inputErrorOf([&] { writeStateFile(folder_ / "link", kState + "!"); }), "");
  EXPECT_EQ(contentOf(folder_ / "target"), kState);
}

TEST_F(StateFileTest, DoesNotWriteThroughALinkAtAForeseeableName)
{
  write(folder_ / "victim", "precious");
  fs::create_symlink(folder_ / "victim", folder_ / "a.state.part");
  writeStateFile(folder_ / "a.state", kState);
  EXPECT_EQ(contentOf(folder_ / "victim"), "precious");
  EXPECT_EQ(contentOf(folder_ / "a.state"), kState);
}

TEST_F(StateFileTest, IsNeitherADeviceNorAPipeNorAFolder)
{
  EXPECT_NE(inputErrorOf([] { writeStateFile("/dev/null", kState); }), "");
  EXPECT_NE(inputErrorOf([&] { writeStateFile(folder_ / "states", kState); }), "");
  ASSERT_EQ(mkfifo((folder_ / "pipe").c_str(), 0600), 0);
  EXPECT_NE(inputErrorOf([&] { writeStateFile(folder_ / "pipe", kState); }), "");
  EXPECT_NE(inputErrorOf([&] { readStateFile(folder_ / "pipe"); }).find("is no file"), std::string::npos)
      << "without a wait";
  EXPECT_NE(inputErrorOf([] { readStateFile("/dev/zero"); }), "");
}

TEST_F(StateFileTest, OfAnotherKindOrSizeIsRefusedBeforeItIsRead)
{
  const fs::path file = folder_ / "large";
  write(file, "no state");
  fs::resize_file(file, 10ULL << 30U);  // a hole: 10 GB
  EXPECT_NE(inputErrorOf([&] { readStateFile(file); }).find("is not a saved state"), std::string::npos);
  fs::resize_file(file, 0);
  write(file, kState);
  fs::resize_file(file, 10ULL << 30U);
  EXPECT_NE(inputErrorOf([&] { readStateFile(file); }).find("is larger than any"), std::string::npos);
}

TEST_F(StateFileTest, LiesBelowTheFolderOfStates)
{
  const std::string states = folder_ / "states";
  EXPECT_EQ(writeStateFile("a.state", kState, states), states + "/a.state");
  EXPECT_EQ(readStateFile("a.state", states), kState);
  EXPECT_EQ(readStateFile(states + "/a.state", states), kState);
  write(folder_ / "b.state", kState);
  fs::create_directory_symlink(folder_, folder_ / "states/out");
  for (const std::string outside : {"../b.state", "out/b.state", "/tmp/b.state"})
  {
    EXPECT_NE(inputErrorOf([&] { writeStateFile(outside, kState, states); }).find("~state_folder"), std::string::npos)
        << outside;
    EXPECT_NE(inputErrorOf([&] { readStateFile(outside, states); }).find("~state_folder"), std::string::npos)
        << outside;
  }
}

}  // namespace
}  // namespace endovascular_sim::nodes
