#include "fluoroscopy/patient/volume/volume_file.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>

#include "common/error.h"
#include "test/fluoroscopy/patient/volume_shapes.h"

namespace endovascular_sim::fluoroscopy
{
namespace
{

class VolumeFile : public testing::Test
{
protected:
  VolumeFile()
  {
    image::VolumeGrid grid = cubicGrid(6, 1e-3, {0.1, 0.2, 0.3});
    grid.size = {6, 5, 4};
    volume_ = std::make_unique<DensityVolume>(grid);
    for (std::size_t i = 0; i < volume_->voxels().size(); ++i)
      volume_->voxels()[i] = static_cast<std::uint16_t>(1000 + 37 * i);
    file_ = (std::filesystem::temp_directory_path() / ("volume_" + std::to_string(getpid()) + ".evsvol")).string();
    writeVolume(file_, *volume_, 77);
  }
  ~VolumeFile() override { std::filesystem::remove(file_); }

  void overwrite(std::streamoff offset, char byte)
  {
    std::fstream file(file_, std::ios::in | std::ios::out | std::ios::binary);
    file.seekp(offset);
    file.put(byte);
  }

  void flip(std::streamoff offset)
  {
    std::ifstream file(file_, std::ios::binary);
    file.seekg(offset);
    overwrite(offset, static_cast<char>(file.get() ^ 0x10));
  }

  /** Message of the error of readVolume(). */
  std::string error() const
  {
    try
    {
      readVolume(file_);
    }
    catch (const InputError& error)
    {
      return error.what();
    }
    return "";
  }

  std::unique_ptr<DensityVolume> volume_;
  std::string file_;
};

TEST_F(VolumeFile, IsReadAsItWasWritten)
{
  const DensityVolume read = readVolume(file_);
  EXPECT_EQ(read.voxels(), volume_->voxels());
  EXPECT_EQ(read.grid().size, volume_->grid().size);
  EXPECT_EQ(read.grid().origin, volume_->grid().origin);
  EXPECT_EQ(read.grid().spacing, volume_->grid().spacing);
  EXPECT_EQ(read.grid().axes, volume_->grid().axes);
}

TEST_F(VolumeFile, AnyDamagedByteIsFound)
{
  const auto size = static_cast<std::streamoff>(std::filesystem::file_size(file_));
  ASSERT_EQ(size, 192 + 2 * 120);
  for (std::streamoff offset = 0; offset < size; ++offset)
  {
    writeVolume(file_, *volume_, 77);
    flip(offset);
    EXPECT_NE(error().find(file_), std::string::npos) << offset;
  }
}

TEST_F(VolumeFile, ATruncatedFileIsNamedBeforeMemoryIsAllocated)
{
  std::filesystem::resize_file(file_, 300);
  EXPECT_NE(error().find("truncated or damaged"), std::string::npos);
  std::filesystem::resize_file(file_, 100);
  EXPECT_NE(error().find("is not a density volume"), std::string::npos);
}

TEST_F(VolumeFile, AnotherVersionIsNamed)
{
  overwrite(8, 2);
  EXPECT_NE(error().find("version"), std::string::npos);
}

TEST_F(VolumeFile, TheCacheAnswersOnlyForTheRightKeyAndAnIntactFile)
{
  EXPECT_TRUE(readCachedVolume(file_, 77).has_value());
  EXPECT_FALSE(readCachedVolume(file_, 78).has_value());
  EXPECT_FALSE(readCachedVolume(file_ + ".missing", 77).has_value());
  overwrite(250, '\x5a');
  EXPECT_FALSE(readCachedVolume(file_, 77).has_value());
}

TEST_F(VolumeFile, AFolderThatDoesNotExistIsAnError)
{
  EXPECT_THROW(writeVolume("/nonexistent/folder/a.evsvol", *volume_), InputError);
  EXPECT_THROW(readVolume("/nonexistent/a.evsvol"), InputError);
}

}  // namespace
}  // namespace endovascular_sim::fluoroscopy
