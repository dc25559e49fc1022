#include <gtest/gtest.h>
#include <unistd.h>

#include <cstring>
#include <filesystem>
#include <iterator>
#include <string>

#include "common/error.h"
#include "image/volume_file.h"
#include "test/common/input_error_of.h"
#include "test/common/temporary_folder.h"

namespace endovascular_sim::image
{
namespace
{

Volume smallVolume()
{
  Volume volume;
  volume.grid.size = {4, 3, 2};
  volume.grid.spacing = {1e-3, 2e-3, 3e-3};
  volume.grid.origin = {0.1, -0.2, 0.3};
  volume.grid.axes = Eigen::AngleAxisd(0.4, Eigen::Vector3d::UnitZ()).toRotationMatrix();
  volume.modality = Modality::kOther;
  volume.scale = 0.25;
  for (std::int16_t n = 0; n < 24; ++n)
    volume.stored.push_back(static_cast<std::int16_t>(100 * n - 1000));
  return volume;
}

class VolumeFile : public testing::Test
{
protected:
  /** Message of the rejection of a file with a content; empty without one. */
  std::string rejectionOf(const std::string& content) const
  {
    return inputErrorOf([&] { readVolume(folder_.write("head.vol", content)); });
  }

  std::string content() const { return contentOf(file_); }

  TemporaryFolder folder_;
  std::string file_ = folder_.file("head.vol");
};

TEST_F(VolumeFile, HoldsTheVolumeBitForBit)
{
  const Volume volume = smallVolume();
  writeVolume(file_, volume);
  const Volume read = readVolume(file_);
  EXPECT_EQ(read.grid.size, volume.grid.size);
  EXPECT_EQ(read.grid.spacing, volume.grid.spacing);
  EXPECT_EQ(read.grid.origin, volume.grid.origin);
  EXPECT_EQ(read.grid.axes, volume.grid.axes);
  EXPECT_EQ(read.modality, volume.modality);
  EXPECT_EQ(read.scale, volume.scale);
  EXPECT_EQ(read.stored, volume.stored);
  EXPECT_EQ(read.at(3, 2, 1), 0.25 * 1300);
  EXPECT_EQ(std::distance(std::filesystem::directory_iterator(folder_.path()), {}), 1) << "no temporary file is left";
}

TEST_F(VolumeFile, EveryDamagedByteAndEveryLengthIsRejected)
{
  writeVolume(file_, smallVolume());
  const std::string good = content();
  for (std::size_t length = 0; length < good.size(); ++length)
    EXPECT_NE(rejectionOf(good.substr(0, length)), "") << length;
  EXPECT_NE(rejectionOf(good + "x").find("bytes in place of"), std::string::npos);
  for (std::size_t n = 160; n < good.size(); ++n)
  {
    std::string bad = good;
    bad[n] = static_cast<char>(bad[n] ^ 1);
    EXPECT_NE(rejectionOf(bad).find("damaged"), std::string::npos) << n;
  }
  EXPECT_EQ(rejectionOf(good), "");
}

TEST_F(VolumeFile, AHugeSizeIsRejectedWithoutMemory)
{
  writeVolume(file_, smallVolume());
  std::string bad = content();
  const std::int32_t most = 8192;
  for (int axis = 0; axis < 3; ++axis)
    std::memcpy(&bad[8 + 4 * static_cast<std::size_t>(axis)], &most, sizeof most);
  EXPECT_NE(rejectionOf(bad).find("bytes in place of"), std::string::npos);
}

TEST_F(VolumeFile, AForeignFileIsRejectedWithTheRemedy)
{
  EXPECT_NE(rejectionOf("solid vessel").find("volume_import"), std::string::npos);
  std::filesystem::remove(file_);
  EXPECT_THROW(readVolume(file_), InputError);
  EXPECT_THROW(writeVolume(folder_.file("none/head.vol"), smallVolume()), InputError);
}

}  // namespace
}  // namespace endovascular_sim::image
