#include "nodes/support/contact_conversions.h"

#include <gtest/gtest.h>

namespace endovascular_sim::nodes
{
namespace
{

TEST(ContactConversions, AQueryComesBackBitForBit)
{
  contact::Query query;
  query.step = 123456789012ULL;
  query.substep = 3;
  query.pass = 17;
  query.wanted_free_distance = 2.5e-3;
  query.margin = 0.1 + 0.2;
  query.first_node = 41;
  query.nodes = {{0.1, 1.0 / 3.0, -7e-300}, {1e-3, -0.0, 5.0}};
  query.radius = {4.45e-4, 3.5e-4};
  RodState message;
  toMessage(query, message);
  contact::Query back;
  fromMessage(message, back);
  EXPECT_EQ(back.step, query.step);
  EXPECT_EQ(back.substep, query.substep);
  EXPECT_EQ(back.pass, query.pass);
  EXPECT_EQ(back.wanted_free_distance, query.wanted_free_distance);
  EXPECT_EQ(back.margin, query.margin);
  EXPECT_EQ(back.first_node, query.first_node);
  EXPECT_EQ(back.nodes, query.nodes);
  EXPECT_EQ(back.radius, query.radius);
}

TEST(ContactConversions, AContactSetComesBackBitForBit)
{
  contact::ContactSet set;
  set.step = 9;
  set.substep = 1;
  set.pass = 2;
  set.vessel_version = 5;
  set.first_edge = 7;
  set.free_distance = {0.25e-3, 1.0 / 7.0};
  contact::Feature feature;
  feature.edge = 8;
  feature.parameter = 1.0 / 3.0;
  feature.point = {0.1, 0.2, 0.3};
  feature.normal = {0.6, 0.8, -0.0};
  feature.gap = -1e-5;
  feature.friction = 0.1;
  feature.triangle = 12345;
  feature.id = 3LL * 4000000000LL + 2;
  set.features = {feature};
  ContactSet message;
  toMessage(set, message);
  contact::ContactSet back;
  fromMessage(message, back);
  EXPECT_EQ(back.step, set.step);
  EXPECT_EQ(back.substep, set.substep);
  EXPECT_EQ(back.pass, set.pass);
  EXPECT_EQ(back.vessel_version, set.vessel_version);
  EXPECT_EQ(back.first_edge, set.first_edge);
  EXPECT_EQ(back.free_distance, set.free_distance);
  ASSERT_EQ(back.features.size(), 1U);
  EXPECT_EQ(back.features[0].edge, feature.edge);
  EXPECT_EQ(back.features[0].parameter, feature.parameter);
  EXPECT_EQ(back.features[0].point, feature.point);
  EXPECT_EQ(back.features[0].normal, feature.normal);
  EXPECT_EQ(back.features[0].gap, feature.gap);
  EXPECT_EQ(back.features[0].clearance_radius, feature.clearance_radius);
  EXPECT_EQ(back.features[0].stiffness, feature.stiffness);
  EXPECT_EQ(back.features[0].friction, feature.friction);
  EXPECT_EQ(back.features[0].triangle, feature.triangle);
  EXPECT_EQ(back.features[0].id, feature.id);
}

TEST(ContactConversions, FeaturesGoOntoTheWireAsFieldByFieldAlthoughTheyAreCopiedAsABlock)
{
  static_assert(ros::message_traits::IsSimple<ContactFeature>::value, "as a block");
  ContactSet message;
  message.features.resize(2);
  message.features[0].edge = 8;
  message.features[0].point.y = 0.2;
  message.features[1].triangle = 12345;
  message.features[1].normal.z = -0.7;
  message.features[1].friction = 0.1;
  message.features[1].feature = 3LL * 4000000000LL + 2;
  std::vector<std::uint8_t> whole(ros::serialization::serializationLength(message));
  ros::serialization::OStream stream(whole.data(), static_cast<std::uint32_t>(whole.size()));
  ros::serialization::serialize(stream, message);
  std::vector<std::uint8_t> fields(2 * sizeof(ContactFeature));
  ros::serialization::OStream by_fields(fields.data(), static_cast<std::uint32_t>(fields.size()));
  for (const ContactFeature& feature : message.features)
  {
    by_fields.next(feature.edge);
    by_fields.next(feature.triangle);
    by_fields.next(feature.parameter);
    by_fields.next(feature.point);
    by_fields.next(feature.normal);
    by_fields.next(feature.gap);
    by_fields.next(feature.clearance_radius);
    by_fields.next(feature.stiffness);
    by_fields.next(feature.friction);
    by_fields.next(feature.feature);
  }
  ASSERT_EQ(by_fields.getLength(), 0U);
  ASSERT_GE(whole.size(), fields.size());
  EXPECT_TRUE(std::equal(fields.begin(), fields.end(), whole.end() - static_cast<std::ptrdiff_t>(fields.size())));
  ros::serialization::IStream input(whole.data(), static_cast<std::uint32_t>(whole.size()));
  ContactSet back;
  ros::serialization::deserialize(input, back);
  ASSERT_EQ(back.features.size(), 2U);
  EXPECT_EQ(back.features[1].feature, message.features[1].feature);
  EXPECT_EQ(back.features[0].point.y, message.features[0].point.y);
}

}  // namespace
}  // namespace endovascular_sim::nodes
