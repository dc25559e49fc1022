#include "nodes/session/bag_writer.h"

#include <unistd.h>

#include <chrono>
#include <filesystem>
#include <thread>

#include <geometry_msgs/PointStamped.h>
#include <gtest/gtest.h>
#include <rosbag/view.h>

namespace endovascular_sim::nodes
{
namespace
{

std::string freshFile(const std::string& name)
{
  const std::filesystem::path file =
      std::filesystem::temp_directory_path() / (name + std::to_string(::getpid()) + ".bag");
  std::filesystem::remove(file);
  return file.string();
}

boost::shared_ptr<geometry_msgs::PointStamped> pointAt(double time)
{
  const auto message = boost::make_shared<geometry_msgs::PointStamped>();
  message->header.stamp = ros::Time(time);
  message->point.x = time;
  return message;
}

TEST(BagWriter, WritesFewMessagesBeforeItIsClosed)
{
  const std::string file = freshFile("few");
  BagWriter writer(file);
  writer.write("/point", ros::Time(1.0), pointAt(1.0));
  for (int k = 0; k < 500 && writer.messages() == 0; ++k)
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  EXPECT_EQ(writer.messages(), 1U);
  writer.close();
  std::filesystem::remove(file);
}

TEST(BagWriter, RetainsOrderAndTimesOfAllMessages)
{
  const std::string file = freshFile("many");
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
  std::filesystem::remove(file);
}

}  // namespace
}  // namespace endovascular_sim::nodes
