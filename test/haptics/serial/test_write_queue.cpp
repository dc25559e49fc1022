#include "haptics/serial/write_queue.h"

#include <gtest/gtest.h>

namespace endovascular_sim::haptics
{
namespace
{

class Sink : public ByteSink
{
public:
  std::size_t write(const std::uint8_t* data, std::size_t size) override
  {
    const std::size_t taken = std::min(size, room);
    bytes.insert(bytes.end(), data, data + taken);
    room -= taken;
    return taken;
  }
  std::size_t room = 1000;
  Bytes bytes;
};

TEST(WriteQueue, RetainsOnlyTheLatestForceForABlockedPort)
{
  WriteQueue queue;
  Sink sink;
  sink.room = 0;
  queue.setLatest({1, 1, 1});
  queue.flush(sink, 0.0);
  EXPECT_TRUE(queue.blocked());
  for (std::uint8_t i = 2; i < 100; ++i)
  {
    queue.setLatest({i, i, i});
    queue.flush(sink, 0.0);
  }
  sink.room = 1000;
  queue.flush(sink, 0.0);
  EXPECT_EQ(sink.bytes, (Bytes{1, 1, 1, 99, 99, 99})) << "the partially written frame, then the latest one";
  EXPECT_EQ(queue.superseded(), 97U);
  EXPECT_TRUE(queue.empty());
}

TEST(WriteQueue, CompletesAPartialFrameFirst)
{
  WriteQueue queue;
  Sink sink;
  sink.room = 2;
  queue.setLatest({1, 2, 3, 4});
  queue.flush(sink, 0.0);
  queue.setLatest({5, 6});
  queue.pushControl({7, 8});
  queue.flush(sink, 0.0);
  sink.room = 100;
  queue.flush(sink, 0.0);
  EXPECT_EQ(sink.bytes, (Bytes{1, 2, 3, 4, 7, 8, 5, 6}));
}

TEST(WriteQueue, WritesAtTheSpeedOfTheLineSoThatForcesDoNotAge)
{
  WriteQueue queue(10000.0);  // 1 ms per byte
  Sink sink;
  for (int millisecond = 0; millisecond < 100; ++millisecond)
  {
    queue.setLatest(Bytes(10, static_cast<std::uint8_t>(millisecond)));
    queue.flush(sink, 1e-3 * millisecond);
  }
  EXPECT_EQ(sink.bytes.size(), 100U);
  for (std::size_t i = 0; i < sink.bytes.size(); ++i)
    EXPECT_EQ(sink.bytes[i], i / 10 * 10) << "each frame was the newest at the time of writing";
}

TEST(WriteQueue, DropsProtocolFramesBeyondItsDepth)
{
  WriteQueue queue;
  for (int i = 0; i < 20; ++i)
    queue.pushControl({1});
  EXPECT_EQ(queue.dropped(), 4U);
}

}  // namespace
}  // namespace endovascular_sim::haptics
