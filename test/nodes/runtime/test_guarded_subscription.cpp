#include "nodes/runtime/guarded_subscription.h"

#include <cstring>
#include <stdexcept>
#include <vector>

#include <geometry_msgs/PolygonStamped.h>
#include <gtest/gtest.h>
#include <sensor_msgs/JointState.h>

namespace endovascular_sim::nodes
{
namespace
{

template <typename Message>
std::vector<std::uint8_t> serialised(const Message& message)
{
  std::vector<std::uint8_t> bytes(ros::serialization::serializationLength(message));
  ros::serialization::OStream stream(bytes.data(), static_cast<std::uint32_t>(bytes.size()));
  ros::serialization::serialize(stream, message);
  return bytes;
}

/** Subscription without a graph. */
template <typename Message>
class Bench
{
public:
  using Event = const ros::MessageEvent<Message const>&;

  explicit Bench(const boost::function<void(Event)>& take)
    : callback_("/topic_of_" + std::string(::testing::UnitTest::GetInstance()->current_test_info()->name()), take,
                ros::DefaultMessageCreator<Message>())
  {
  }

  /** Receives bytes as roscpp does. @return true when they were a message */
  bool receive(std::vector<std::uint8_t> bytes)
  {
    ros::SubscriptionCallbackHelperDeserializeParams parameters;
    parameters.buffer = bytes.data();
    parameters.length = static_cast<std::uint32_t>(bytes.size());
    const ros::VoidConstPtr message = callback_.deserialize(parameters);
    if (!message)
      return false;
    ros::SubscriptionCallbackHelperCallParams call;
    call.event = ros::MessageEvent<void const>(message, boost::make_shared<ros::M_string>(), ros::Time(1.0), false,
                                               [] { return boost::shared_ptr<void>(); });
    callback_.call(call);
    return true;
  }

private:
  GuardedCallback<Event> callback_;
};

sensor_msgs::JointState joints()
{
  sensor_msgs::JointState message;
  message.name = {"insertion", "rotation"};
  message.position = {0.1, 0.2};
  return message;
}

TEST(GuardedSubscription, PassesAMessageOn)
{
  sensor_msgs::JointState received;
  Bench<sensor_msgs::JointState> bench([&](const auto& event) { received = *event.getConstMessage(); });
  ASSERT_TRUE(bench.receive(serialised(joints())));
  EXPECT_EQ(received, joints());
}

TEST(GuardedSubscription, AnExceptionOfTheCallbackEndsNothingAndIsCounted)
{
  const std::uint64_t before = IgnoredMessages::ofProcess().count();
  Bench<sensor_msgs::JointState> bench([](const auto&) { throw std::out_of_range("vector::at"); });
  EXPECT_NO_THROW(bench.receive(serialised(joints())));
  EXPECT_EQ(IgnoredMessages::ofProcess().count(), before + 1);
}

TEST(GuardedSubscription, TruncatedAndSurplusBytesAreIgnored)
{
  Bench<sensor_msgs::JointState> bench([](const auto&) { FAIL(); });
  const std::vector<std::uint8_t> whole = serialised(joints());
  for (std::size_t size = 0; size < whole.size(); ++size)
    EXPECT_FALSE(bench.receive({whole.begin(), whole.begin() + static_cast<std::ptrdiff_t>(size)})) << size;
  std::vector<std::uint8_t> more = whole;
  more.push_back(0);
  EXPECT_FALSE(bench.receive(more));
}

TEST(GuardedSubscription, AnArrayLongerThanItsMessageReservesNoMemory)
{
  Bench<geometry_msgs::PolygonStamped> bench([](const auto&) { FAIL(); });
  std::vector<std::uint8_t> bytes = serialised(geometry_msgs::PolygonStamped());
  for (const std::uint32_t count : {0xffffffffU, 0x7fffffffU, 1U})  // the first would be 48 GB
  {
    std::memcpy(bytes.data() + bytes.size() - sizeof count, &count, sizeof count);
    EXPECT_FALSE(bench.receive(bytes));
  }
}

}  // namespace
}  // namespace endovascular_sim::nodes
