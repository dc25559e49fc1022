#include "common/numerics/parallel_for.h"

#include <stdexcept>
#include <vector>

#include <gtest/gtest.h>

using endovascular_sim::parallelFor;

TEST(ParallelFor, CallsEveryIndexOnce)
{
  for (const int threads : {1, 4})
  {
    std::vector<int> calls(1000, 0);
    parallelFor(calls.size(), threads, [&](std::size_t k) { ++calls[k]; });
    EXPECT_EQ(calls, std::vector<int>(1000, 1));
  }
}

TEST(ParallelFor, PassesAnExceptionOn)
{
  EXPECT_THROW(parallelFor(50, 3,
                           [](std::size_t k)
                           {
                             if (k == 20)
                               throw std::runtime_error("twenty");
                           }),
               std::runtime_error);
}
