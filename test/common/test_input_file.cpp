#include "common/input_file.h"

#include <unistd.h>

#include <filesystem>
#include <fstream>

#include <gtest/gtest.h>

#include "common/output_file.h"
#include "test/common/input_error_of.h"

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
  EXPECT_EQ(inputErrorOf([&] { openInputFile(missing, "give a state"); }),
            missing + ": cannot be read (No such file or directory); give a state");
  EXPECT_EQ(inputErrorOf([&] { openInputFile(folder_.string(), "give a state"); }),
            folder_.string() + ": cannot be read (Is a directory); give a state");
}

TEST_F(FilesInAFolder, PreventAFolderOfTheSameName)
{
  createFolder((folder_ / "new" / "folder").string());
  createFolder((folder_ / "new" / "folder").string());
  EXPECT_TRUE(std::filesystem::is_directory(folder_ / "new" / "folder"));
  const std::string file = (folder_ / "file").string();
  EXPECT_EQ(inputErrorOf([&] { createFolder(file); }),
            file + ": the folder cannot be created (Not a directory); choose an existing folder");
  EXPECT_NE(inputErrorOf([&] { createFolder(file + "/below"); }), "");
}

}  // namespace
}  // namespace endovascular_sim
