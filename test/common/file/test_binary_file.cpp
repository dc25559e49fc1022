#include "common/file/binary_file.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "common/error.h"
#include "test/common/temporary_folder.h"

namespace endovascular_sim
{
namespace
{

class CacheFile : public testing::Test
{
protected:
  CacheFile() { writeCacheFile(file(), 77, {bytesOf(values_), "text"}); }

  std::string file() const { return folder_.file("entry"); }

  const std::vector<std::uint16_t> values_ = {1, 2, 65535};
  TemporaryFolder folder_;
};

TEST_F(CacheFile, HoldsItsPartsUnderTheKey)
{
  const std::string bytes = std::string(bytesOf(values_)) + "text";
  EXPECT_EQ(readCacheFile(file(), 77), bytes);
  EXPECT_FALSE(readCacheFile(file(), 78));
  EXPECT_FALSE(readCacheFile(file() + ".missing", 77));
  writeCacheFile(file(), 78, {});
  EXPECT_EQ(readCacheFile(file(), 78), "");
}

TEST_F(CacheFile, IsNothingAfterAnyDamage)
{
  const auto size = std::filesystem::file_size(file());
  for (std::uintmax_t at = 0; at < size; ++at)
  {
    std::fstream stream(file(), std::ios::in | std::ios::out | std::ios::binary);
    stream.seekg(static_cast<std::streamoff>(at));
    const char byte = static_cast<char>(stream.get());
    const auto put = [&](char other)
    {
      stream.seekp(static_cast<std::streamoff>(at));
      stream.put(other).flush();
    };
    put(static_cast<char>(byte ^ 0x10));
    EXPECT_FALSE(readCacheFile(file(), 77)) << at;
    put(byte);
  }
  EXPECT_TRUE(readCacheFile(file(), 77));
  std::filesystem::resize_file(file(), size - 1);
  EXPECT_FALSE(readCacheFile(file(), 77));
  std::filesystem::resize_file(file(), 7);
  EXPECT_FALSE(readCacheFile(file(), 77));
}

TEST_F(CacheFile, LeavesNoTemporaryFileAndNamesTheReasonOfAFailure)
{
  std::size_t files = 0;
  for (const auto& entry : std::filesystem::directory_iterator(folder_.path()))
    files += entry.exists() ? 1 : 0;
  EXPECT_EQ(files, 1U);
  EXPECT_THROW(writeBinaryFile("/nowhere/file", {"a"}), InputError);
  EXPECT_THROW(writeCacheFile("/proc/none/file", 1, {"a"}), InputError);
}

}  // namespace
}  // namespace endovascular_sim
