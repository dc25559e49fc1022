#include "nodes/conversions/contact_set_serializer.h"

#include <limits>

#include <gtest/gtest.h>

namespace endovascular_sim::nodes
{
namespace
{

StampedContactSet someSet()
{
  StampedContactSet message;
  message.header.stamp = ros::Time(12, 34);
  message.header.frame_id = "patient";
  contact::ContactSet& set = message.set;
  set.step = 123456789012ULL;
  set.substep = 3;
  set.pass = 17;
  set.vessel_version = 5;
  set.first_edge = 7;
  set.free_distance = {0.25e-3, 1.0 / 7.0, std::numeric_limits<double>::infinity()};
  contact::Feature feature;
  feature.edge = 8;
  feature.triangle = 12345;
  feature.parameter = 1.0 / 3.0;
  feature.point = {0.1, 0.2, 0.3};
  feature.normal = {0.6, 0.8, -0.0};
  feature.gap = -1e-5;
  feature.clearance_radius = 2.5e-3;
  feature.stiffness = 4e5;
  feature.friction = 0.1;
  feature.id = 3LL * 4000000000LL + 2;
  set.features = {feature, contact::Feature()};
  set.features[1].edge = 9;
  set.features[1].id = -1;
  return message;
}

template <typename Message>
std::vector<std::uint8_t> bytesOf(const Message& message)
{
  std::vector<std::uint8_t> bytes(ros::serialization::serializationLength(message));
  ros::serialization::OStream stream(bytes.data(), static_cast<std::uint32_t>(bytes.size()));
  ros::serialization::serialize(stream, message);
  EXPECT_EQ(stream.getLength(), 0U) << "serializationLength equals the written length";
  return bytes;
}

template <typename Message>
Message messageOf(std::vector<std::uint8_t> bytes)
{
  Message message;
  ros::serialization::IStream stream(bytes.data(), static_cast<std::uint32_t>(bytes.size()));
  ros::serialization::deserialize(stream, message);
  EXPECT_EQ(stream.getLength(), 0U) << "all bytes are read";
  return message;
}

TEST(StampedContactSetMessage, IsReadAsAContactSetMessage)
{
  namespace traits = ros::message_traits;
  EXPECT_STREQ(traits::md5sum<StampedContactSet>(), traits::md5sum<ContactSet>());
  EXPECT_STREQ(traits::datatype<StampedContactSet>(), traits::datatype<ContactSet>());
  EXPECT_STREQ(traits::definition<StampedContactSet>(), traits::definition<ContactSet>());
  const StampedContactSet sent = someSet();
  const ContactSet read = messageOf<ContactSet>(bytesOf(sent));
  EXPECT_EQ(read.header.stamp, sent.header.stamp);
  EXPECT_EQ(read.header.frame_id, "patient");
  EXPECT_EQ(read.step, sent.set.step);
  EXPECT_EQ(read.substep, 3);
  EXPECT_EQ(read.pass, 17);
  EXPECT_EQ(read.vessel_version, 5U);
  EXPECT_EQ(read.first_edge, 7U);
  EXPECT_EQ(read.free_distance, sent.set.free_distance);
  ASSERT_EQ(read.features.size(), 2U);
  const contact::Feature& feature = sent.set.features[0];
  EXPECT_EQ(read.features[0].edge, feature.edge);
  EXPECT_EQ(read.features[0].triangle, feature.triangle);
  EXPECT_EQ(read.features[0].parameter, feature.parameter);
  EXPECT_EQ(read.features[0].point.x, feature.point.x());
  EXPECT_EQ(read.features[0].point.y, feature.point.y());
  EXPECT_EQ(read.features[0].point.z, feature.point.z());
  EXPECT_EQ(read.features[0].normal.x, feature.normal.x());
  EXPECT_EQ(read.features[0].normal.y, feature.normal.y());
  EXPECT_TRUE(std::signbit(read.features[0].normal.z));
  EXPECT_EQ(read.features[0].gap, feature.gap);
  EXPECT_EQ(read.features[0].clearance_radius, feature.clearance_radius);
  EXPECT_EQ(read.features[0].stiffness, feature.stiffness);
  EXPECT_EQ(read.features[0].friction, feature.friction);
  EXPECT_EQ(read.features[0].feature, feature.id);
  EXPECT_EQ(read.features[1].edge, 9);
  EXPECT_EQ(read.features[1].feature, -1);
}

TEST(StampedContactSetMessage, ReadsAContactSetMessageBitForBit)
{
  const std::vector<std::uint8_t> bytes = bytesOf(messageOf<ContactSet>(bytesOf(someSet())));
  EXPECT_EQ(bytesOf(messageOf<StampedContactSet>(bytes)), bytes);
  EXPECT_EQ(bytes, bytesOf(someSet()));
}

TEST(StampedContactSetMessage, MayContainNoFeatures)
{
  StampedContactSet message;
  message.set.free_distance = {1e-3};
  const StampedContactSet read = messageOf<StampedContactSet>(bytesOf(message));
  EXPECT_TRUE(read.set.features.empty());
  EXPECT_EQ(read.set.free_distance, message.set.free_distance);
}

TEST(StampedContactSetMessage, RejectsACountBeyondTheReceivedFeatures)
{
  StampedContactSet empty;
  std::vector<std::uint8_t> bytes = bytesOf(empty);
  for (const std::uint32_t claimed : {1U, 1000U, std::numeric_limits<std::uint32_t>::max()})
  {
    std::memcpy(bytes.data() + bytes.size() - sizeof(claimed), &claimed, sizeof(claimed));
    EXPECT_THROW(messageOf<StampedContactSet>(bytes), ros::serialization::StreamOverrunException) << claimed;
  }
}

}  // namespace
}  // namespace endovascular_sim::nodes
