#include "common/input_file.h"

#include <unistd.h>

#include <filesystem>
#include <fstream>

#include <gtest/gtest.h>

#include "common/error.h"
#include "common/output_file.h"

namespace endovascular_sim
{
namespace
{

/** Folder for one test, removed at its end. */
class FilesInAFolder : public testing::Test
{
protected:
  void SetUp() override
  {
    folder_ = std::filesystem::temp_directory_path() / ("test_files_" + std::to_string(::getpid()));
    std::filesystem::create_directories(folder_);
    std::ofstream(folder_ / "file") << "text";
  }
  void TearDown() override { std::filesystem::remove_all(folder_); }

  template <typename Call>
  std::string messageOf(Call&& call)
  {
    try
    {
      call();
    }
    catch (const InputError& error)
    {
      return error.what();
    }
    return "";
  }

  std::filesystem::path folder_;
};

TEST_F(FilesInAFolder, AreOpenedForReading)
{
  std::string text;
  openInputFile((folder_ / "file").string(), "give a file") >> text;
  EXPECT_EQ(text, "text");
}

TEST_F(FilesInAFolder, AreReportedWithReasonAndRemedyIfMissingOrAFolder)
{
  const std::string missing = (folder_ / "missing").string();
  EXPECT_EQ(messageOf([&] { openInputFile(missing, "give a state"); }),
            missing + ": cannot be read (No such file or directory); give a state");
  EXPECT_EQ(messageOf([&] { openInputFile(folder_.string(), "give a state"); }),
            folder_.string() + ": cannot be read (Is a directory); give a state");
}

TEST_F(FilesInAFolder, PreventAFolderOfTheSameName)
{
  createFolder((folder_ / "new" / "folder").string());
  createFolder((folder_ / "new" / "folder").string());
  EXPECT_TRUE(std::filesystem::is_directory(folder_ / "new" / "folder"));
  const std::string file = (folder_ / "file").string();
  EXPECT_EQ(messageOf([&] { createFolder(file); }),
            file + ": the folder cannot be created (Not a directory); choose an existing folder");
  EXPECT_NE(messageOf([&] { createFolder(file + "/below"); }), "");
}

}  // namespace
}  // namespace endovascular_sim
