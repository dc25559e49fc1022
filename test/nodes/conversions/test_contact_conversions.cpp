#include "nodes/conversions/contact_conversions.h"

#include <gtest/gtest.h>

namespace endovascular_sim::nodes
{
namespace
{

TEST(ContactConversions, RoundTripAQueryBitForBit)
{
  contact::Query query;
  query.step = 123456789012ULL;
  query.substep = 3;
  query.pass = 17;
  query.first_node = 41;
  query.nodes = {{0.1, 1.0 / 3.0, -7e-300}, {1e-3, -0.0, 5.0}};
  query.radius = {4.45e-4, 3.5e-4};
  query.margin = {0.1 + 0.2, 0.2 / 3.0};
  RodState message;
  toMessage(query, 2.5e-3, message);
  contact::Query back;
  fromMessage(message, back);
  EXPECT_EQ(back.step, query.step);
  EXPECT_EQ(back.substep, query.substep);
  EXPECT_EQ(back.pass, query.pass);
  EXPECT_EQ(message.wanted_free_distance, 2.5e-3);
  EXPECT_EQ(back.first_node, query.first_node);
  EXPECT_EQ(back.nodes, query.nodes);
  EXPECT_EQ(back.radius, query.radius);
  EXPECT_EQ(back.margin, query.margin);
}

}  // namespace
}  // namespace endovascular_sim::nodes
