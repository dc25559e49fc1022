#include "haptics/rosserial/rosserial_protocol.h"

#include <gtest/gtest.h>

#include <random>

#include "test/haptics/recordings.h"

namespace endovascular_sim::haptics
{
namespace
{

using test::fromHex;
using test::parseAll;

const Bytes kTimeRequest = fromHex("fffe0800f70a000000000000000000f5");

Bytes sum(std::initializer_list<Bytes> pieces)
{
  Bytes all;
  for (const Bytes& piece : pieces)
    all.insert(all.end(), piece.begin(), piece.end());
  return all;
}

TEST(RosserialEncoder, ProducesTheBytesOfTheOriginalImplementation)
{
  EXPECT_EQ(encodeTopicRequest(), fromHex("fffe0000ff0000ff"));
  EXPECT_EQ(encodeFrame(kTime, Bytes(8, 0)), kTimeRequest);
  EXPECT_EQ(encodeFrame(126, fromHex("0a000000")), fromHex("fffe0400fb7e000a00000077"));
  EXPECT_THROW(encodeFrame(100, Bytes(0x10000)), std::length_error);
}

TEST(RosserialParser, FindsFramesFedByteByByte)
{
  FrameParser parser;
  std::vector<Frame> frames;
  for (const std::uint8_t byte : sum({kTimeRequest, encodeFrame(300, {1, 2, 3})}))
    parser.feed(&byte, 1, frames);
  ASSERT_EQ(frames.size(), 2U);
  EXPECT_EQ(frames[0].id, kTime);
  EXPECT_EQ(frames[1].id, 300);
  EXPECT_EQ(frames[1].payload, (Bytes{1, 2, 3}));
  EXPECT_EQ(parser.counters().resyncs, 0U);
}

TEST(RosserialParser, SkipsAHeaderWithALengthAboveTheLimit)
{
  FrameParser parser;
  const auto frames = parseAll(parser, sum({fromHex("fffe0010ef"), kTimeRequest}));
  ASSERT_EQ(frames.size(), 1U) << "the frame must be found immediately, not after 4096 bytes";
  EXPECT_EQ(frames[0].id, kTime);
  EXPECT_EQ(parser.counters().over_long, 1U);
  EXPECT_EQ(parser.counters().resyncs, 1U);
  EXPECT_EQ(parser.counters().skipped_bytes, 5U);
}

TEST(RosserialParser, CountsWrongLengthAndMessageChecksumsSeparately)
{
  FrameParser parser;
  Bytes bad_length = kTimeRequest;
  bad_length[4] ^= 1;
  Bytes bad_sum = kTimeRequest;
  bad_sum.back() ^= 1;
  EXPECT_EQ(parseAll(parser, sum({bad_length, bad_sum, kTimeRequest})).size(), 1U);
  EXPECT_EQ(parser.counters().bad_lengths, 1U);
  EXPECT_EQ(parser.counters().bad_sums, 1U);
}

TEST(RosserialParser, DoesNotMistakeASyncInsideAPayload)
{
  FrameParser parser;
  const Bytes inner = encodeFrame(125, {0xff, 0xfe, 0xff});
  const auto frames = parseAll(parser, sum({encodeFrame(100, inner), encodeFrame(101, inner)}));
  ASSERT_EQ(frames.size(), 2U);
  EXPECT_EQ(frames[0].payload, inner);
}

TEST(RosserialParser, RescansFromTheByteAfterAFalseSync)
{
  // The false header announces 20 bytes and covers the complete valid frame after it.
  FrameParser parser;
  const auto frames = parseAll(parser, sum({fromHex("fffe1400eb"), kTimeRequest, kTimeRequest}));
  EXPECT_EQ(frames.size(), 2U);
  EXPECT_EQ(parser.counters().bad_sums, 1U);
  FrameParser doubled;
  EXPECT_EQ(parseAll(doubled, sum({{0xff}, kTimeRequest})).size(), 1U) << "ff ff fe ...";
}

TEST(RosserialParser, IsIndependentOfTheDivisionOfTheStream)
{
  std::mt19937 random(7);
  Bytes stream;
  for (int i = 0; i < 300; ++i)
  {
    Bytes piece(random() % 40);
    for (std::uint8_t& byte : piece)
      byte = static_cast<std::uint8_t>(random() % 4 == 0 ? 0xff - random() % 2 : random());
    stream = sum({stream, random() % 2 ? piece : encodeFrame(static_cast<std::uint16_t>(random()), piece)});
  }
  FrameParser whole;
  const auto expected = parseAll(whole, stream);
  ASSERT_GT(expected.size(), 100U);
  for (int trial = 0; trial < 50; ++trial)
  {
    FrameParser parser;
    std::vector<Frame> frames;
    for (std::size_t begin = 0, size = 0; begin < stream.size(); begin += size)
    {
      size = std::min<std::size_t>(random() % 60, stream.size() - begin);
      parser.feed(stream.data() + begin, size, frames);
    }
    ASSERT_EQ(frames.size(), expected.size());
    for (std::size_t i = 0; i < frames.size(); ++i)
      ASSERT_TRUE(frames[i].id == expected[i].id && frames[i].payload == expected[i].payload);
    EXPECT_EQ(parser.counters().resyncs, whole.counters().resyncs);
    EXPECT_EQ(parser.counters().bad_sums, whole.counters().bad_sums);
    EXPECT_EQ(parser.counters().skipped_bytes, whole.counters().skipped_bytes);
  }
}

TEST(RosserialParser, FindsTheFrameAfterAnyGarbageWithinThePayloadLimit)
{
  std::mt19937 random(11);
  const Bytes marker = encodeFrame(4711, {1, 2, 3, 4});
  for (int trial = 0; trial < 20000; ++trial)
  {
    Bytes stream(random() % 200);
    for (std::uint8_t& byte : stream)
      byte = static_cast<std::uint8_t>(random() % 3 == 0 ? 0xff - random() % 2 : random() % 8);
    stream = sum({stream, marker, Bytes(kDefaultPayloadCap + kFrameOverhead, 0)});
    FrameParser parser;
    bool found = false;
    for (const Frame& frame : parseAll(parser, stream))
      found = found || frame.id == 4711 || frame.payload.size() >= marker.size();  // or garbage that is a valid frame
    ASSERT_TRUE(found) << "trial " << trial;
  }
}

TEST(RosserialParser, HandlesMillionsOfRandomBytes)
{
  std::mt19937 random(1);
  FrameParser parser;
  std::vector<Frame> frames;
  Bytes bytes(4096);
  for (int block = 0; block < 1000; ++block)
  {
    for (std::uint8_t& byte : bytes)
      byte = static_cast<std::uint8_t>(block % 2 == 0 || random() % 4 != 0 ? random() : 0xff - random() % 2);
    parser.feed(bytes.data(), bytes.size(), frames);
  }
  const ParserCounters& counters = parser.counters();
  EXPECT_EQ(counters.bytes, 4096000U);
  std::uint64_t in_frames = 0;
  for (const Frame& frame : frames)
    in_frames += frame.payload.size() + kFrameOverhead;
  EXPECT_EQ(counters.frames, frames.size());
  EXPECT_LE(counters.bytes - in_frames - counters.skipped_bytes, kDefaultPayloadCap + kFrameOverhead)
      << "every byte is in a frame, skipped, or in the bounded buffer";
  EXPECT_GT(counters.bad_lengths, 0U);
}

class RosserialRecording : public testing::TestWithParam<const char*>
{
};

TEST_P(RosserialRecording, IsParsedWithoutLossInBothDirections)
{
  const auto pieces = test::readRecording(GetParam());
  if (pieces.empty())
    GTEST_SKIP() << test::kNoRecordings;
  for (const bool from_device : {true, false})
  {
    FrameParser parser;
    const Bytes bytes = test::joined(pieces, from_device);
    Bytes again;
    for (const Frame& frame : parseAll(parser, bytes))
      again = sum({again, encodeFrame(frame.id, frame.payload)});
    EXPECT_EQ(parser.counters().bad_lengths + parser.counters().bad_sums + parser.counters().over_long, 0U);
    EXPECT_LT(bytes.size() - again.size(), 200U) << "at most the frame truncated at the end of the recording";
    EXPECT_TRUE(std::equal(again.begin(), again.end(), bytes.begin())) << "encoding reproduces the recorded bytes";
  }
}

INSTANTIATE_TEST_SUITE_P(All, RosserialRecording,
                         testing::Values("handshake_100hz.tap", "force_1khz_to_device.tap", "stall_3_to_10s.tap"));

TEST(RosserialRecordings, ContainTheManuallyDecodedFrames)
{
  const auto pieces = test::readRecording("handshake_100hz.tap");
  if (pieces.empty())
    GTEST_SKIP() << test::kNoRecordings;
  std::ifstream list(test::recordingFolder() + "frames.txt");
  std::string line;
  int checked = 0;
  while (std::getline(list, line))
  {
    double time = 0.0;
    unsigned id = 0;
    unsigned length = 0;
    char direction[16];
    char hex[4096];
    ASSERT_EQ(std::sscanf(line.c_str(), "%lf %15s topic=%u len=%u %4095s", &time, direction, &id, &length, hex), 5);
    const bool from_device = std::string(direction) == "dev>host";
    bool found = false;
    for (const test::Piece& piece : pieces)
    {
      if (piece.from_device != from_device || std::abs(piece.time - time) > 1e-6)
        continue;
      FrameParser parser;
      for (const Frame& frame : parseAll(parser, piece.bytes))
        found = found || (frame.id == id && frame.payload.size() == length &&
                          encodeFrame(frame.id, frame.payload) == fromHex(hex));
    }
    EXPECT_TRUE(found) << line;
    ++checked;
  }
  EXPECT_GE(checked, 12);
}

}  // namespace
}  // namespace endovascular_sim::haptics
