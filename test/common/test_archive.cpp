#include "common/archive.h"

#include <string>
#include <vector>

#include <gtest/gtest.h>

namespace endovascular_sim
{
namespace
{

TEST(Archive, OfAVectorOfNumbersHasTheBytesOfTheSingleNumbers)
{
  std::vector<double> numbers{1.5, -0.0, 3e300};
  std::uint64_t size = numbers.size();
  Archive whole, single;
  whole(numbers);
  single(size, numbers[0], numbers[1], numbers[2]);
  EXPECT_EQ(whole.bytes(), single.bytes());
  std::vector<double> read{7.0};
  Archive archive(whole.bytes());
  archive(read);
  EXPECT_EQ(read, numbers);
  EXPECT_TRUE(archive.atEnd());
}

TEST(Archive, HoldsEmptyVectorsAndVectorsOfObjects)
{
  std::vector<double> none, read_none{1.0};
  std::vector<std::string> words{"a", "", "catheter"}, read_words;
  Archive written;
  written(none, words);
  Archive read(written.bytes());
  read(read_none, read_words);
  EXPECT_TRUE(read_none.empty());
  EXPECT_EQ(read_words, words);
}

TEST(Archive, ThatIsTruncatedIsRefused)
{
  std::vector<int> numbers{1, 2, 3};
  Archive written;
  written(numbers);
  for (std::size_t size = 0; size < written.bytes().size(); ++size)
  {
    Archive cut(written.bytes().substr(0, size));
    std::vector<int> read;
    EXPECT_THROW(cut(read), ArchiveError) << size;
  }
}

}  // namespace
}  // namespace endovascular_sim
