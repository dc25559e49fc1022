#include "haptics/rosserial/rosserial_messages.h"

#include <gtest/gtest.h>

#include <random>

#include "haptics/rosserial/byte_stream.h"
#include "test/haptics/recordings.h"

namespace endovascular_sim::haptics
{
namespace
{

using test::fromHex;

Bytes payloadOf(const char* hex)
{
  FrameParser parser;
  return test::parseAll(parser, fromHex(hex)).at(0).payload;
}

TEST(RosserialMessages, DecodeTheAnnouncementOfTheOriginalClient)
{
  const Bytes payload = payloadOf(
      "fffe5200ad010064000c0000006861707469632f666f7263651400000067656f6d657472795f6d7367732f5772656e636820000000346635"
      "33"
      "396366313338623233323833623532306664323731623536373933360002"
      "00007f");
  const TopicInfo info = decodeTopicInfo(payload);
  EXPECT_EQ(info.id, 100);
  EXPECT_EQ(info.name, "haptic/force");
  EXPECT_EQ(info.type, "geometry_msgs/Wrench");
  EXPECT_EQ(info.md5, "4f539cf138b23283b520fd271b567936");
  EXPECT_EQ(info.buffer_size, 512);
  EXPECT_EQ(encode(info), payload);
}

TEST(RosserialMessages, DecodeTheJointStateOfTheOriginalClient)
{
  const Bytes payload = payloadOf(
      "fffe6700987d000400000040bd006ba5873a0b06000000686170746963020000000400000070757368050000007477697374020000002d38"
      "89"
      "ec68a8333fb81e85eb51b89e3f02000000000000000000000000000000000000000200000000000000000000000000000000000000"
      "92");
  const JointState state = decodeJointState(payload);
  EXPECT_EQ(state.sequence, 4U);
  EXPECT_EQ(state.frame, "haptic");
  EXPECT_EQ(state.names, (std::vector<std::string>{"push", "twist"}));
  ASSERT_EQ(state.positions.size(), 2U);
  EXPECT_NEAR(state.positions[0], 0.0003, 1e-4);
  EXPECT_DOUBLE_EQ(state.positions[1], 0.03);
  EXPECT_EQ(encode(state), payload);
}

TEST(RosserialMessages, DecodeTheWrenchOfTheOriginalServer)
{
  const Bytes payload = payloadOf(
      "fffe3000cf6400000000000000f83f0000000000000000000000000000000000000000000000000000000000000000000000000000d03f5"
      "5");
  const Wrench wrench = decodeWrench(payload);
  EXPECT_EQ(wrench.force[0], 1.5);
  EXPECT_EQ(wrench.torque[2], 0.25);
  EXPECT_EQ(encode(wrench), payload);
}

TEST(RosserialMessages, EncodeSampleAndForceInTheDocumentedLayout)
{
  HapticSample sample;
  sample.time = 0x04030201;
  sample.insertion = 1.0F;
  sample.rotation = -2.0F;
  sample.flags = 5;
  EXPECT_EQ(encode(sample), fromHex("010203040000803f000000c005"));
  const HapticSample back = decodeHapticSample(encode(sample));
  EXPECT_EQ(back.time, sample.time);
  EXPECT_EQ(back.insertion, sample.insertion);
  EXPECT_EQ(back.rotation, sample.rotation);
  EXPECT_EQ(back.flags, sample.flags);

  const HapticForce force{7, 0.5F, -0.25F, DeviceState::kPaused};
  EXPECT_EQ(encode(force), fromHex("070000000000003f000080be02"));
  EXPECT_EQ(decodeHapticForce(encode(force)).state, DeviceState::kPaused);
}

TEST(RosserialMessages, RejectPayloadsOfAWrongLength)
{
  for (std::size_t size = 0; size < 40; ++size)
  {
    const Bytes zeros(size, 0);
    if (size != HapticSample::kSize)
    {
      EXPECT_THROW(decodeHapticSample(zeros), PayloadError) << size;
    }
    if (size != HapticForce::kSize)
    {
      EXPECT_THROW(decodeHapticForce(zeros), PayloadError) << size;
    }
    if (size != 8)
    {
      EXPECT_THROW(decodeTime(zeros), PayloadError) << size;
    }
  }
}

TEST(RosserialMessages, RejectAnArrayCountBeyondThePayload)
{
  Bytes payload = encode(JointState());
  for (const std::size_t at : {12U, 16U, 20U, 24U, 28U})  // frame length, then four counts
  {
    Bytes broken = payload;
    std::fill_n(broken.begin() + static_cast<std::ptrdiff_t>(at), 4, std::uint8_t{0xff});
    EXPECT_THROW(decodeJointState(broken), PayloadError) << at;
  }
}

TEST(RosserialMessages, NeverReadBeyondARandomPayload)
{
  std::mt19937 random(3);
  for (int trial = 0; trial < 30000; ++trial)
  {
    Bytes payload(random() % 100);
    for (std::uint8_t& byte : payload)
      byte = static_cast<std::uint8_t>(random() % 3 == 0 ? random() : 0);
    for (int kind = 0; kind < 4; ++kind)
    {
      try
      {
        if (kind == 0)
          decodeTopicInfo(payload);
        if (kind == 1)
          decodeJointState(payload);
        if (kind == 2)
          decodeLog(payload);
        if (kind == 3)
          decodeWrench(payload);
      }
      catch (const PayloadError&)
      {
      }
    }
  }
}

}  // namespace
}  // namespace endovascular_sim::haptics
