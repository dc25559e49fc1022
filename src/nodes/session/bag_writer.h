#pragma once

#include <condition_variable>
#include <cstdint>
#include <deque>
#include <functional>
#include <mutex>
#include <string>
#include <thread>

#include <ros/message_event.h>
#include <rosbag/bag.h>
#include <boost/make_shared.hpp>

namespace endovascular_sim::nodes
{

/** Writes a bag, and other files of a session, on a thread of its own, so that a slow disk does not hold up messages.
 *
 *  The queue is bounded: what does not fit is dropped and counted. When the disk runs full the bag is closed while
 *  there is still room for its index; from then on everything is dropped and error() says why. */
class BagWriter
{
public:
  /** @param file path of the bag
   *  @throws InputError when it cannot be made */
  explicit BagWriter(const std::string& file);
  ~BagWriter();
  BagWriter(const BagWriter&) = delete;
  BagWriter& operator=(const BagWriter&) = delete;

  /** Queues a received message; a latched topic stays marked as such. Does not block. */
  template <typename Message>
  void write(const std::string& topic, const ros::MessageEvent<Message const>& event)
  {
    push([topic, event](rosbag::Bag& bag) { bag.write(topic, event); });
  }

  /** Queues a message of this process. Does not block. @param time that it is recorded with */
  template <typename Message>
  void write(const std::string& topic, ros::Time time, const boost::shared_ptr<Message>& message)
  {
    push([topic, time, message](rosbag::Bag& bag) { bag.write(topic, time, *message); });
  }

  /** Queues a message of this process as one of a latched topic. Does not block. */
  template <typename Message>
  void writeLatched(const std::string& topic, const Message& message)
  {
    const auto copy = boost::make_shared<Message>(message);
    const auto header = boost::make_shared<ros::M_string>();
    // A header of one's own replaces the whole of what rosbag writes about the topic.
    (*header)["latching"] = "1";
    (*header)["type"] = ros::message_traits::datatype<Message>();
    (*header)["md5sum"] = ros::message_traits::md5sum<Message>();
    (*header)["message_definition"] = ros::message_traits::definition<Message>();
    const ros::Time now = ros::Time::now();
    push([topic, copy, header, now](rosbag::Bag& bag) { bag.write(topic, now, *copy, header); });
  }

  /** Queues other work for the thread, for example a picture to write; it is not counted as a message. */
  void run(std::function<void()> work);

  /** Writes what is queued, ends the thread and closes the bag. Further messages are dropped. */
  void close();

  const std::string& file() const { return file_; }
  std::uint64_t bytes() const;
  std::uint64_t messages() const;
  std::uint64_t dropped() const;
  std::string error() const;

private:
  using Work = std::function<void(rosbag::Bag&)>;
  struct Item
  {
    Work work;
    bool is_message = false;
  };

  void push(Work work);
  void enqueue(Item item);
  void loop();
  void process(const Item& item);
  void checkRoom();
  void fail(const std::string& reason);
  void closeBag();

  std::string file_;
  rosbag::Bag bag_;
  bool bag_open_ = true;              // writer thread, then close()
  std::uint64_t bytes_at_check_ = 0;  // writer thread

  mutable std::mutex mutex_;
  std::condition_variable wake_;
  std::deque<Item> queue_;
  bool ending_ = false;
  std::uint64_t messages_ = 0;
  std::uint64_t dropped_ = 0;
  std::string error_;

  std::thread thread_;
};

}  // namespace endovascular_sim::nodes
