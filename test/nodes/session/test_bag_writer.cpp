#include "nodes/session/bag_writer.h"

#include <unistd.h>

#include <chrono>
#include <thread>

#include <geometry_msgs/PointStamped.h>
#include <gtest/gtest.h>
#include <rosbag/view.h>

#include "test/common/temporary_folder.h"

namespace endovascular_sim::nodes
{
namespace
{

boost::shared_ptr<geometry_msgs::PointStamped> pointAt(double time)
{
  const auto message = boost::make_shared<geometry_msgs::PointStamped>();
  message->header.stamp = ros::Time(time);
  message->point.x = time;
  return message;
}

TEST(BagWriter, WritesFewMessagesBeforeItIsClosed)
{
  const TemporaryFolder folder;
  BagWriter writer(folder.file("few.bag"));
  writer.write("/point", ros::Time(1.0), pointAt(1.0));
  for (int k = 0; k < 500 && writer.messages() == 0; ++k)
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  EXPECT_EQ(writer.messages(), 1U);
  writer.close();
}

TEST(BagWriter, RetainsOrderAndTimesOfAllMessages)
{
  const TemporaryFolder folder;
  const std::string file = folder.file("many.bag");
  {
    BagWriter writer(file);
    for (int k = 1; k <= 3000; ++k)
      writer.write("/point", ros::Time(1.0), pointAt(k));  // equal times: rosbag sorts by time
    writer.close();
    EXPECT_EQ(writer.messages(), 3000U);
    EXPECT_EQ(writer.dropped(), 0U);
  }
  rosbag::Bag bag(file);
  int next = 1;
  for (const rosbag::MessageInstance& message : rosbag::View(bag))
  {
    const auto point = message.instantiate<geometry_msgs::PointStamped>();
    ASSERT_TRUE(point);
    EXPECT_EQ(point->point.x, next);
    EXPECT_EQ(message.getTime().toSec(), 1.0);
    ++next;
  }
  EXPECT_EQ(next, 3001);
  bag.close();
}

}  // namespace
}  // namespace endovascular_sim::nodes
