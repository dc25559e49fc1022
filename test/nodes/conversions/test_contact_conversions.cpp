#include "nodes/conversions/contact_conversions.h"

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
  query.wide_margin = 0.1 / 3.0;
  query.fast_margin = 0.2 / 3.0;
  query.fast_begin = 41;
  query.fast_end = 42;
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
  EXPECT_EQ(back.wide_margin, query.wide_margin);
  EXPECT_EQ(back.fast_margin, query.fast_margin);
  EXPECT_EQ(back.fast_begin, query.fast_begin);
  EXPECT_EQ(back.fast_end, query.fast_end);
  EXPECT_EQ(back.first_node, query.first_node);
  EXPECT_EQ(back.nodes, query.nodes);
  EXPECT_EQ(back.radius, query.radius);
}

}  // namespace
}  // namespace endovascular_sim::nodes
