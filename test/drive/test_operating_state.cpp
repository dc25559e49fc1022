#include "drive/operating_state.h"

#include <gtest/gtest.h>

namespace endovascular_sim::drive
{
namespace
{

TEST(OperatingState, HasTheNamesOfCrtk)
{
  for (const OperatingState state :
       {OperatingState::kDisabled, OperatingState::kEnabled, OperatingState::kPaused, OperatingState::kFault})
    EXPECT_EQ(operatingState(nameOf(state)), state);
  EXPECT_STREQ(nameOf(OperatingState::kPaused), "PAUSED");
  EXPECT_FALSE(operatingState("paused"));
}

TEST(OperatingState, OrdersStatesFromEnabledToFault)
{
  EXPECT_EQ(worse(OperatingState::kEnabled, OperatingState::kPaused), OperatingState::kPaused);
  EXPECT_EQ(worse(OperatingState::kDisabled, OperatingState::kPaused), OperatingState::kDisabled);
  EXPECT_EQ(worse(OperatingState::kDisabled, OperatingState::kFault), OperatingState::kFault);
}

}  // namespace
}  // namespace endovascular_sim::drive
