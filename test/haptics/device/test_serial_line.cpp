#include "haptics/device/serial_line.h"

#include <gtest/gtest.h>

namespace endovascular_sim::haptics
{
namespace
{

TEST(SerialLine, TransmitsTenBitsPerByte)
{
  SerialLine line(230400.0, 1000);
  line.push(Bytes(21, 7), 1.0);
  EXPECT_TRUE(line.pull(1.0 + 10.0 / 230400.0 * 0.99).empty());
  EXPECT_EQ(line.pull(1.0 + 210.0 / 230400.0 - 1e-9).size(), 20U);
  EXPECT_NEAR(line.emptyAt(), 1.0 + 210.0 / 230400.0, 1e-12);
  EXPECT_EQ(line.pull(2.0).size(), 1U);
}

TEST(SerialLine, LosesBytesBeyondTheCapacityOfItsFifo)
{
  SerialLine line(9600.0, 8);
  line.push({1, 2, 3, 4, 5}, 0.0);
  line.push({6, 7, 8, 9, 10}, 0.0);
  EXPECT_EQ(line.lost(), 2U);
  EXPECT_EQ(line.pull(1.0), (Bytes{1, 2, 3, 4, 5, 6, 7, 8}));
}

TEST(SerialLine, NeverExceedsItsSpeed)
{
  SerialLine line(10000.0, 64);
  std::size_t carried = 0;
  for (int i = 0; i < 1000; ++i)
  {
    line.push(Bytes(3, 1), 1e-3 * i);
    carried += line.pull(1e-3 * i).size();
  }
  EXPECT_LE(carried, 1000U);
  EXPECT_GE(carried, 990U);
}

}  // namespace
}  // namespace endovascular_sim::haptics
