#include "benchmark/harness/table.h"

#include <cmath>

#include <gtest/gtest.h>

namespace endovascular_sim::benchmark
{
namespace
{

TEST(Table, QuotesCellsWithCommas)
{
  Table table({"a", "b, c"});
  table.add({"1", "x, y"});
  EXPECT_EQ(table.csv(), "a,\"b, c\"\n1,\"x, y\"\n");
  EXPECT_EQ(table.markdown(), "| a | b, c |\n|---|---|\n| 1 | x, y |\n");
}

TEST(Table, ShowsNaNAsAnEmptyCell)
{
  EXPECT_EQ(number(std::nan("")), "");
  EXPECT_EQ(number(0.00123456), "0.00123");
  EXPECT_EQ(number(1.0 / 3.0, 6), "0.333333");
}

}  // namespace
}  // namespace endovascular_sim::benchmark
