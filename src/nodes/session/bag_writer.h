#pragma once

#include <algorithm>
#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <deque>
#include <functional>
#include <map>
#include <mutex>
#include <string>
#include <thread>

#include <ros/message_event.h>
#include <rosbag/bag.h>
#include <boost/make_shared.hpp>

namespace endovascular_sim::nodes
{

/** Writer of a bag and other files of a session, in its own thread: a slow disk does not delay messages.
 *
 *  The bag is compressed with LZ4. Its chunks are closed at least twice a second: a killed process loses no more. The
 * queue is bounded; messages that do not fit are dropped and counted. Before the disk is full the bag is closed, while
 * there is space for its index. From then on, and after a failed write, all messages are dropped, and error() holds the
 * reason of the operating system. Connections are written without host names (PrivateText). */
class BagWriter
{
public:
  /** @param file path of the bag
   *  @throws InputError when it cannot be created */
  explicit BagWriter(const std::string& file);
  ~BagWriter();
  BagWriter(const BagWriter&) = delete;
  BagWriter& operator=(const BagWriter&) = delete;

  /** Queues a received message; the bag retains whether its topic is latched. Does not block. */
  template <typename Message>
  void write(const std::string& topic, const ros::MessageEvent<Message const>& event)
  {
    write(topic, event.getReceiptTime(), event);
  }

  /** Queues a received message with another time in the bag, e.g. a latched one of an earlier bag. Does not block. */
  template <typename Message>
  void write(const std::string& topic, ros::Time time, const ros::MessageEvent<Message const>& event)
  {
    push([topic, time, message = event.getConstMessage(), header = recordedHeader(event.getConnectionHeaderPtr())](
             rosbag::Bag& bag) { bag.write(topic, valid(time), *message, header); });
  }

  /** Queues a message of this process. Does not block. @param time time of the message in the bag */
  template <typename Message>
  void write(const std::string& topic, ros::Time time, const boost::shared_ptr<Message>& message)
  {
    push([topic, time, message](rosbag::Bag& bag) { bag.write(topic, valid(time), *message); });
  }

  /** Queues a message of this process on a latched topic. Does not block. @param time of the message in the bag */
  template <typename Message>
  void writeLatched(const std::string& topic, const Message& message, ros::Time time = ros::Time::now())
  {
    const auto copy = boost::make_shared<Message>(message);
    push([topic, copy, time](rosbag::Bag& bag) { bag.write(topic, valid(time), *copy, latchedHeader<Message>()); });
  }

  /** Connection header of a latched topic. A given header replaces the one that rosbag would write. */
  template <typename Message>
  static boost::shared_ptr<ros::M_string> latchedHeader()
  {
    const auto header = boost::make_shared<ros::M_string>();
    (*header)["latching"] = "1";
    (*header)["type"] = ros::message_traits::datatype<Message>();
    (*header)["md5sum"] = ros::message_traits::md5sum<Message>();
    (*header)["message_definition"] = ros::message_traits::definition<Message>();
    return header;
  }

  /** Queues other work of the thread, for example an image to write; it does not count as a message. */
  void run(std::function<void()> work);

  /** Writes all queued messages, ends the thread and closes the bag. Later messages are dropped. */
  void close();

  const std::string& file() const { return file_; }
  std::uint64_t bytes() const;     ///< size of the bag [B]
  std::uint64_t messages() const;  ///< number of messages written
  std::uint64_t dropped() const;   ///< number of messages dropped, for whatever reason
  std::string error() const;       ///< reason of an early end; empty without one
  bool isHalfFull() const;         ///< true while the queue holds more than half of its capacity

private:
  /** Simulated time begins at 0, which no bag may hold. */
  static ros::Time valid(ros::Time time) { return std::max(time, ros::TIME_MIN); }

  using Work = std::function<void(rosbag::Bag&)>;
  using Clock = std::chrono::steady_clock;
  using Header = boost::shared_ptr<ros::M_string>;
  struct Item
  {
    Work work;
    bool is_message = false;
  };

  Header recordedHeader(const Header& header);
  void push(Work work);
  void enqueue(Item item);
  void loop();
  void process(const Item& item);
  void write(const Item& item);
  void endChunk();
  void watchDisk();
  void checkSpace();
  void fail(const std::string& reason);
  std::string folder() const;
  void closeBag();

  std::string file_;
  rosbag::Bag bag_;
  std::map<Header, Header> headers_;  ///< recorded headers by the received ones; used by the caller's thread
  // Used by the thread, then by close().
  bool bag_open_ = true;
  bool chunk_has_messages_ = false;
  bool chunk_was_ended_ = false;      ///< true: the threshold of a chunk must be restored after the next message
  Clock::time_point chunk_ended_;     ///< end of the last chunk
  Clock::time_point space_checked_;   ///< last check of the free space
  std::uint64_t bytes_at_check_ = 0;  ///< size of the bag then [B]

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
