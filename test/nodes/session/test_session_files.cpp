#include "nodes/session/session_files.h"

#include <filesystem>
#include <fstream>

#include <gtest/gtest.h>

#include "test/common/input_error_of.h"
#include "test/common/temporary_folder.h"

namespace endovascular_sim::nodes
{
namespace
{

class SessionsOfFolders : public testing::Test
{
protected:
  /** Creates an empty file with its folders. @return its path */
  std::string create(const std::string& name) const
  {
    const std::string file = folder_.file(name);
    std::filesystem::create_directories(std::filesystem::path(file).parent_path());
    std::ofstream(file) << "";
    return file;
  }

  TemporaryFolder folder_;
};

TEST_F(SessionsOfFolders, AreThoseInItAndBelowIt)
{
  create("class/anna/session.bag");
  create("class/anna/run_2/session.bag");
  create("class/anna/report.json");
  create("class/ben/session.bag");
  const std::vector<SessionFiles> sessions = sessionsOf({folder_.file("class")});
  ASSERT_EQ(sessions.size(), 3U);
  EXPECT_EQ(sessions[0].folder, "class/anna");
  EXPECT_EQ(sessions[1].folder, "class/anna/run_2");
  EXPECT_EQ(sessions[2].folder, "class/ben");
  EXPECT_EQ(sessions[2].bags, std::vector<std::string>{folder_.file("class/ben/session.bag")});
}

TEST_F(SessionsOfFolders, HaveTheBagsOfOneFolderInTheOrderOfTheirNumbers)
{
  for (const char* name : {"a/session_10.bag", "a/session.bag", "a/session_2.bag"})
    create(name);
  const std::vector<SessionFiles> sessions = sessionsOf({folder_.file("a/")});
  ASSERT_EQ(sessions.size(), 1U);
  EXPECT_EQ(sessions[0].folder, "a");
  EXPECT_EQ(sessions[0].bags, (std::vector<std::string>{folder_.file("a/session.bag"), folder_.file("a/session_2.bag"),
                                                        folder_.file("a/session_10.bag")}));
}

TEST_F(SessionsOfFolders, HaveBagsThatArePlayedTogetherOnlyIfThereIsASingleSession)
{
  for (const char* name : {"class/anna/session.bag", "class/anna/session_2.bag", "class/ben/session.bag"})
    create(name);
  EXPECT_EQ(bagsOf({folder_.file("class")}).size(), 3U);
  EXPECT_EQ(
      bagsOfOneSession({folder_.file("class/anna")}),
      (std::vector<std::string>{folder_.file("class/anna/session.bag"), folder_.file("class/anna/session_2.bag")}));
  const std::string error = inputErrorOf([&] { bagsOfOneSession({folder_.file("class")}); });
  EXPECT_NE(error.find("holds 2 sessions; give one of them"), std::string::npos) << error;
}

TEST_F(SessionsOfFolders, AreOneForEachBagWithANameOfItsOwn)
{
  for (const char* name : {"class/anna.bag", "class/ben.bag", "class/session_anna.bag"})
    create(name);
  const std::vector<SessionFiles> sessions = sessionsOf({folder_.file("class")});
  ASSERT_EQ(sessions.size(), 3U);
  EXPECT_EQ(sessions[0].folder, "class/ben");
  EXPECT_EQ(sessions[1].folder, "class/anna");
  EXPECT_EQ(sessions[2].folder, "class/session_anna");
}

TEST_F(SessionsOfFolders, HaveFoldersOfTheirOwnWhereFilesHaveEqualNames)
{
  const std::vector<SessionFiles> sessions =
      sessionsOf({create("x/anna/session.bag"), create("y/anna/session.bag"), create("y/other.bag")});
  ASSERT_EQ(sessions.size(), 3U);
  EXPECT_EQ(sessions[0].folder, "anna");
  EXPECT_EQ(sessions[1].folder, "anna_2");
  EXPECT_EQ(sessions[2].folder, "other");
}

TEST_F(SessionsOfFolders, AreRefusedWithoutABag)
{
  create("empty/report.json");
  const std::string error = inputErrorOf([&] { sessionsOf({folder_.file("empty")}); });
  EXPECT_NE(error.find("holds no bag"), std::string::npos) << error;
}

}  // namespace
}  // namespace endovascular_sim::nodes
