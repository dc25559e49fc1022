#include "nodes/session/bag_writer.h"

#include <cerrno>
#include <chrono>
#include <filesystem>
#include <utility>
#include <vector>

#include <ros/console.h>

#include "common/output_file.h"
#include "nodes/session/private_text.h"

namespace endovascular_sim::nodes
{

namespace
{

/** Capacity of the queue [messages]: 20 s of all recorded topics. */
constexpr std::size_t kQueueCapacity = 40000;
/** Number of queued messages that wakes the thread, and the longest wait: batches avoid a wake-up per message. */
constexpr std::size_t kBatch = 256;
constexpr std::chrono::milliseconds kLongestWait{100};
/** Least free space on the disk, sufficient for the index of the bag and the report [B]. */
constexpr std::uintmax_t kReserve = 64U << 20U;
/** Written size between two checks of the free space [B]. */
constexpr std::uint64_t kCheckInterval = 8U << 20U;
constexpr std::chrono::milliseconds kSpaceInterval{500};  ///< longest time between two checks of the free space
/** Size of a chunk before compression [B], and its longest duration. The open chunk is lost if the process is killed.
 */
constexpr std::uint32_t kChunkSize = 256U << 10U;
constexpr std::chrono::milliseconds kChunkDuration{400};

}  // namespace

BagWriter::BagWriter(const std::string& file) : file_(file)
{
  checkSpace();
  if (!error_.empty())
    throw InputError(file_, "recording", error_);
  errno = 0;
  try
  {
    bag_.open(file_, rosbag::bagmode::Write);
    bag_.setCompression(rosbag::compression::LZ4);
    bag_.setChunkThreshold(kChunkSize);
    chunk_ended_ = space_checked_ = Clock::now();
  }
  catch (const rosbag::BagException& exception)
  {
    if (errno != 0)
      throw writeError(file_);
    throw InputError(file_, "recording",
                     std::string(exception.what()) + "; choose an existing, writable folder with free space");
  }
  thread_ = std::thread([this] { loop(); });
}

BagWriter::~BagWriter()
{
  close();
}

/** Connection header for the bag: type, hash, definition and latching. The publisher's host name is removed. */
BagWriter::Header BagWriter::recordedHeader(const Header& header)
{
  Header& recorded = headers_[header];
  if (recorded || !header)
    return recorded;
  recorded = boost::make_shared<ros::M_string>();
  for (const char* field : {"callerid", "latching", "md5sum", "message_definition", "type"})
    if (const auto found = header->find(field); found != header->end())
      (*recorded)[field] = found->second;
  if (const auto name = recorded->find("callerid"); name != recorded->end())
    name->second = PrivateText::ofProcess().removedFrom(name->second);
  return recorded;
}

void BagWriter::push(Work work)
{
  enqueue({std::move(work), true});
}

void BagWriter::run(std::function<void()> work)
{
  enqueue({[work = std::move(work)](rosbag::Bag&) { work(); }, false});
}

void BagWriter::enqueue(Item item)
{
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    if (ending_ || queue_.size() >= kQueueCapacity || (item.is_message && !error_.empty()))
    {
      ++dropped_;
      return;
    }
    queue_.push_back(std::move(item));
    if (queue_.size() != kBatch)
      return;
  }
  wake_.notify_one();
}

void BagWriter::loop()
{
  std::vector<Item> batch;
  std::unique_lock<std::mutex> lock(mutex_);
  while (true)
  {
    wake_.wait_for(lock, kLongestWait, [this] { return ending_ || queue_.size() >= kBatch; });
    for (std::size_t k = 0; k < kBatch && !queue_.empty(); ++k)
    {
      batch.push_back(std::move(queue_.front()));
      queue_.pop_front();
    }
    const bool is_last = ending_ && queue_.empty();
    lock.unlock();
    for (const Item& item : batch)
      process(item);
    batch.clear();  // destroys the messages outside of the lock
    watchDisk();
    if (is_last)
      return;
    lock.lock();
  }
}

void BagWriter::process(const Item& item)
{
  if (item.is_message && !bag_open_)
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    ++dropped_;
    return;
  }
  errno = 0;
  try
  {
    write(item);
  }
  catch (const rosbag::BagException& exception)
  {
    fail(errno == 0 ? exception.what() : writeError(file_).what());
    closeBag();
  }
  catch (const std::exception& exception)
  {
    fail(exception.what());
    closeBag();
  }
}

void BagWriter::write(const Item& item)
{
  item.work(bag_);
  if (!item.is_message)
    return;
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    ++messages_;
  }
  chunk_has_messages_ = true;
  if (!chunk_was_ended_)
    return;
  bag_.setChunkThreshold(kChunkSize);
  chunk_was_ended_ = false;
}

/** Ends the open chunk: its messages reach the operating system, since rosbag then rewrites the chunk's header, which
 *  flushes its buffer. The threshold 0 also makes the next message a chunk, which empties rosbag's copy of the chunk.
 */
void BagWriter::endChunk()
{
  bag_.setChunkThreshold(0);
  chunk_was_ended_ = true;
  chunk_has_messages_ = false;
  chunk_ended_ = Clock::now();
}

/** Ends a chunk and examines the free space when it is time. */
void BagWriter::watchDisk()
{
  if (!bag_open_)
    return;
  const Clock::time_point now = Clock::now();
  errno = 0;
  try
  {
    if (chunk_has_messages_ && now - chunk_ended_ > kChunkDuration)
      endChunk();
  }
  catch (const rosbag::BagException& exception)
  {
    fail(errno == 0 ? exception.what() : writeError(file_).what());
    closeBag();
    return;
  }
  if (now - space_checked_ < kSpaceInterval && bag_.getSize() < bytes_at_check_ + kCheckInterval)
    return;
  space_checked_ = now;
  bytes_at_check_ = bag_.getSize();
  checkSpace();
  if (!error().empty())
    closeBag();
}

void BagWriter::checkSpace()
{
  std::error_code ignored;
  const std::filesystem::space_info space = std::filesystem::space(folder(), ignored);
  if (!ignored && space.available < kReserve)
    fail("less than 64 MB are free on the disk of " + folder() + "; free some space or record elsewhere");
}

std::string BagWriter::folder() const
{
  return std::filesystem::absolute(file_).parent_path().string();
}

void BagWriter::fail(const std::string& reason)
{
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    if (!error_.empty())
      return;
    error_ = reason;
  }
  ROS_ERROR("the recording %s ended early: %s", file_.c_str(), reason.c_str());
}

void BagWriter::closeBag()
{
  if (!bag_open_)
    return;
  bag_open_ = false;
  errno = 0;
  try
  {
    bag_.close();
  }
  catch (const std::exception& exception)
  {
    fail("the index of the bag cannot be written (" + (errno == 0 ? std::string(exception.what()) : systemReason()) +
         "); free some space, then recover its messages with rosbag reindex " + file_);
  }
}

void BagWriter::close()
{
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    ending_ = true;
  }
  wake_.notify_one();
  if (thread_.joinable())
    thread_.join();
  closeBag();
}

std::uint64_t BagWriter::bytes() const
{
  std::error_code ignored;
  const auto size = std::filesystem::file_size(file_, ignored);
  return ignored ? 0 : size;
}

std::uint64_t BagWriter::messages() const
{
  const std::lock_guard<std::mutex> lock(mutex_);
  return messages_;
}

std::uint64_t BagWriter::dropped() const
{
  const std::lock_guard<std::mutex> lock(mutex_);
  return dropped_;
}

std::string BagWriter::error() const
{
  const std::lock_guard<std::mutex> lock(mutex_);
  return error_;
}

bool BagWriter::isHalfFull() const
{
  const std::lock_guard<std::mutex> lock(mutex_);
  return queue_.size() > kQueueCapacity / 2;
}

}  // namespace endovascular_sim::nodes
