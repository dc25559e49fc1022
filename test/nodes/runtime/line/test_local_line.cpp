#include "nodes/runtime/line/local_line.h"

#include <sys/socket.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <thread>

#include <gtest/gtest.h>

namespace endovascular_sim::nodes
{
namespace
{

using Clock = FrameStream::Clock;
using Frame = std::vector<std::uint8_t>;

Clock::time_point after(double seconds)
{
  return Clock::now() + std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(seconds));
}

Frame frameOf(std::size_t size, std::uint8_t first)
{
  Frame frame(size);
  for (std::size_t k = 0; k < size; ++k)
    frame[k] = static_cast<std::uint8_t>(first + k);
  return frame;
}

Frame lastFrame(const FrameStream& stream)
{
  return Frame(stream.frame(), stream.frame() + stream.frameSize());
}

/** Two streams that are connected to each other, and the raw socket of a third pair. */
class Streams : public testing::Test
{
protected:
  void SetUp() override { ASSERT_EQ(socketpair(AF_UNIX, SOCK_STREAM, 0, sockets_.data()), 0); }

  std::array<int, 2> sockets_{};
};

TEST_F(Streams, CarryFramesOfAnySizeInTheirOrder)
{
  FrameStream from(sockets_[0]);
  FrameStream to(sockets_[1]);
  for (const std::size_t size : {0, 1, 100, 200000, 3})
  {
    const Frame frame = frameOf(size, 7);
    std::thread sender([&] { EXPECT_TRUE(from.send(frame, after(10.0))); });
    EXPECT_TRUE(to.receive(after(10.0)));
    EXPECT_EQ(lastFrame(to), frame);
    sender.join();
  }
}

TEST_F(Streams, ReceiveSeveralFramesOfOneRead)
{
  FrameStream from(sockets_[0]);
  FrameStream to(sockets_[1]);
  for (const std::uint8_t first : {1, 2, 3})
    EXPECT_TRUE(from.send(frameOf(10, first), after(1.0)));
  for (const std::uint8_t first : {1, 2, 3})
  {
    ASSERT_TRUE(to.receive(after(1.0)));
    EXPECT_EQ(lastFrame(to), frameOf(10, first));
    EXPECT_EQ(to.hasMore(), first < 3);
  }
  EXPECT_FALSE(to.receive(after(0.0)));
}

TEST_F(Streams, KeepAFrameThatArrivesInPartsAfterTheDeadline)
{
  FrameStream to(sockets_[1]);
  const Frame frame = frameOf(8, 1);
  const std::uint32_t size = 8;
  ASSERT_EQ(write(sockets_[0], &size, sizeof size), 4);
  ASSERT_EQ(write(sockets_[0], frame.data(), 3), 3);
  EXPECT_FALSE(to.receive(after(0.0)));
  EXPECT_FALSE(to.receive(after(0.0)));
  ASSERT_EQ(write(sockets_[0], frame.data() + 3, 5), 5);
  ASSERT_TRUE(to.receive(after(1.0)));
  EXPECT_EQ(lastFrame(to), frame);
  close(sockets_[0]);
}

TEST_F(Streams, DropFramesForAPeerThatDoesNotReadAndContinueWhenItDoes)
{
  FrameStream from(sockets_[0]);
  FrameStream to(sockets_[1]);
  const Frame frame = frameOf(100000, 5);
  std::size_t sent = 0;
  while (sent < 1000 && from.send(frame, after(0.0)))
    ++sent;
  ASSERT_LT(sent, 1000U);
  std::size_t received = 0;
  while (received < sent && to.receive(after(0.0)))
  {
    EXPECT_EQ(lastFrame(to), frame);
    ++received;
    from.receive(after(0.0));  // sends the rest of a begun frame
  }
  EXPECT_EQ(received, sent);
  EXPECT_TRUE(from.send(frameOf(3, 1), after(1.0)));
  ASSERT_TRUE(to.receive(after(1.0)));
  EXPECT_EQ(to.frameSize(), 3U);
}

TEST_F(Streams, CloseOnALengthBeyondEveryFrame)
{
  FrameStream to(sockets_[1]);
  const std::uint32_t size = FrameStream::kLargestFrame + 1;
  ASSERT_EQ(write(sockets_[0], &size, sizeof size), 4);
  EXPECT_FALSE(to.receive(after(10.0)));
  EXPECT_FALSE(to.isOpen());
  close(sockets_[0]);
}

TEST_F(Streams, CloseWithTheirPeer)
{
  FrameStream to(sockets_[1]);
  close(sockets_[0]);
  EXPECT_FALSE(to.receive(after(10.0)));
  EXPECT_FALSE(to.isOpen());
  EXPECT_FALSE(to.send(frameOf(1, 0), after(0.0)));
}

std::string freshName(const std::string& name)
{
  return lineName(name + std::to_string(getpid()), "/contact/set");
}

/** Sends a frame until a server takes it. @return false without one within 10 s */
bool sendSoon(LineClient& client, const Frame& frame)
{
  for (const Clock::time_point end = after(10.0); Clock::now() < end;)
  {
    if (client.send(frame))
      return true;
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  return false;
}

/** Server that returns every frame. */
class Echo
{
public:
  explicit Echo(const std::string& name)
    : server_(name, [this](const std::uint8_t* frame, std::uint32_t size) { server_.send(Frame(frame, frame + size)); })
  {
  }

private:
  LineServer server_;
};

TEST(LocalLine, CarriesFramesThereAndBackAndSurvivesTheRestartOfItsServer)
{
  const std::string name = freshName("restart");
  LineClient client(name);
  EXPECT_FALSE(client.send(frameOf(3, 1)));
  for (int round = 0; round < 2; ++round)
  {
    {
      const Echo echo(name);
      ASSERT_TRUE(sendSoon(client, frameOf(1000, 9)));
      EXPECT_TRUE(client.isConnected());
      const FrameStream* const stream = client.receive(after(10.0));
      ASSERT_NE(stream, nullptr);
      EXPECT_EQ(lastFrame(*stream), frameOf(1000, 9));
    }
    EXPECT_EQ(client.receive(after(10.0)), nullptr);
    EXPECT_FALSE(client.isConnected());
  }
}

TEST(LocalLine, HasOneServerForItsName)
{
  const std::string name = freshName("two");
  std::atomic<int> received{0};
  LineServer first(name, [&](const std::uint8_t* /*frame*/, std::uint32_t /*size*/) { ++received; });
  LineServer second(name, [](const std::uint8_t* /*frame*/, std::uint32_t /*size*/) { FAIL(); });
  LineClient client(name);
  ASSERT_TRUE(sendSoon(client, frameOf(1, 1)));
  for (const Clock::time_point end = after(10.0); received == 0 && Clock::now() < end;)
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  EXPECT_EQ(received, 1);
  EXPECT_TRUE(first.isConnected());
  EXPECT_FALSE(second.isConnected());
  EXPECT_FALSE(second.send(frameOf(1, 1)));
}

TEST(LocalLine, NamesDifferByMasterAndTopic)
{
  EXPECT_EQ(lineName("http://a:1", "/contact/set"), lineName("http://a:1", "/contact/set"));
  EXPECT_NE(lineName("http://a:1", "/contact/set"), lineName("http://a:2", "/contact/set"));
  EXPECT_NE(lineName("http://a:1", "/contact/set"), lineName("http://a:1", "/room/contact/set"));
}

}  // namespace
}  // namespace endovascular_sim::nodes
