#include "nodes/session/bag_writer.h"

#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <csignal>
#include <thread>

#include <geometry_msgs/PointStamped.h>
#include <gtest/gtest.h>
#include <rosbag/view.h>

#include "nodes/session/bag_records.h"
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

TEST(BagWriter, OfAKilledProcessLosesLessThanASecond)
{
  const TemporaryFolder folder;
  const std::string file = folder.file("killed.bag");
  const pid_t writer = ::fork();
  if (writer == 0)
  {
    BagWriter bag(file);
    const auto begin = std::chrono::steady_clock::now();
    while (true)  // until it is killed; each message holds its age
    {
      const std::chrono::duration<double> age = std::chrono::steady_clock::now() - begin;
      bag.write("/point", ros::Time(1.0), pointAt(1.0 + age.count()));
      std::this_thread::sleep_for(std::chrono::milliseconds(5));
    }
  }
  const auto begin = std::chrono::steady_clock::now();
  std::this_thread::sleep_for(std::chrono::milliseconds(2700));
  ::kill(writer, SIGKILL);
  const std::chrono::duration<double> life = std::chrono::steady_clock::now() - begin;
  int status = 0;
  ASSERT_EQ(::waitpid(writer, &status, 0), writer);
  double newest = 0.0;
  readBagMessages(file, [&newest](const BagMessage& message)
                  { newest = std::max(newest, message.read<geometry_msgs::PointStamped>()->point.x - 1.0); });
  EXPECT_GT(newest, life.count() - 1.0);
}

}  // namespace
}  // namespace endovascular_sim::nodes
