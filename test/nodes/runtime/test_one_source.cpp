#include "nodes/runtime/one_source.h"

#include <gtest/gtest.h>

namespace endovascular_sim::nodes
{
namespace
{

TEST(OneSource, IsTheFirstPublisherUntilItIsSilent)
{
  OneSource source;
  OneSource::Clock::time_point now = OneSource::Clock::now();
  EXPECT_NO_THROW(source.require("/rod_dynamics", now));
  EXPECT_THROW(source.require("/stranger", now), std::runtime_error);
  now += std::chrono::milliseconds(1900);
  EXPECT_THROW(source.require("/stranger", now), std::runtime_error);
  EXPECT_NO_THROW(source.require("/rod_dynamics", now));
  now += OneSource::kSilence;
  EXPECT_NO_THROW(source.require("/another", now));
  EXPECT_THROW(source.require("/rod_dynamics", now), std::runtime_error);
}

}  // namespace
}  // namespace endovascular_sim::nodes
