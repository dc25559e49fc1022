#include "common/input_file.h"

#include <unistd.h>

#include <filesystem>

#include <gtest/gtest.h>

#include "common/output_file.h"
#include "test/common/input_error_of.h"
#include "test/common/temporary_folder.h"

namespace endovascular_sim
{
namespace
{

class FilesInAFolder : public testing::Test
{
protected:
  const TemporaryFolder temporary_;
  const std::filesystem::path& folder_ = temporary_.path();
  const std::string file_ = temporary_.write("file", "text");
};

TEST_F(FilesInAFolder, AreOpenedForReading)
{
  std::string text;
  openInputFile(file_, "give a file") >> text;
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
  EXPECT_EQ(inputErrorOf([&] { createFolder(file_); }),
            file_ + ": the folder cannot be created (Not a directory); choose an existing folder");
  EXPECT_NE(inputErrorOf([&] { createFolder(file_ + "/below"); }), "");
}

}  // namespace
}  // namespace endovascular_sim
