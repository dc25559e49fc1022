#include "nodes/conversions/contact_force_conversions.h"

#include <gtest/gtest.h>

namespace endovascular_sim::nodes
{
namespace
{

results::WallForceTotals totalsOf(int region, const std::string& name, double value)
{
  results::WallForceTotals totals;
  totals.region = region;
  totals.name = name;
  totals.peak = value;
  totals.peak_position = {value + 0.1, value + 0.2, value + 0.3};
  totals.peak_region = region;
  totals.peak_time = value + 0.4;
  totals.peak_sum = value + 0.5;
  totals.peak_sum_time = value + 0.6;
  totals.integral = value + 0.7;
  totals.time_over_threshold = value + 0.8;
  return totals;
}

void expectEqual(const results::WallForceTotals& a, const results::WallForceTotals& b)
{
  EXPECT_EQ(a.region, b.region);
  EXPECT_EQ(a.name, b.name);
  EXPECT_EQ(a.peak, b.peak);
  EXPECT_EQ(a.peak_position, b.peak_position);
  EXPECT_EQ(a.peak_region, b.peak_region);
  EXPECT_EQ(a.peak_time, b.peak_time);
  EXPECT_EQ(a.peak_sum, b.peak_sum);
  EXPECT_EQ(a.peak_sum_time, b.peak_sum_time);
  EXPECT_EQ(a.integral, b.integral);
  EXPECT_EQ(a.time_over_threshold, b.time_over_threshold);
}

TEST(ContactForceConversions, RestoreTotalsBitForBitAndTrianglesInSinglePrecision)
{
  results::WallForceSummary summary;
  summary.threshold = 0.1;
  summary.time = 12.0;
  summary.whole = totalsOf(results::kNoRegion, "", 1.0 / 3.0);
  summary.regions = {totalsOf(0, "aorta", 2.0 / 3.0), totalsOf(7, "left_subclavian", 4.0 / 3.0)};
  const std::vector<results::WallForce> touched = {{41, 7, 1.0 / 3.0, 0.25, 0.5, 0.125},
                                                   {3, results::kNoRegion, 1.0, 2.0, 3.0, 4.0}};
  ContactForceMap message;
  toMessage(summary, touched, message);
  const results::WallForceSummary back = summaryFromMessage(message);
  EXPECT_EQ(back.threshold, summary.threshold);
  EXPECT_EQ(back.time, summary.time);
  expectEqual(back.whole, summary.whole);
  ASSERT_EQ(back.regions.size(), 2U);
  expectEqual(back.regions[0], summary.regions[0]);
  expectEqual(back.regions[1], summary.regions[1]);
  const std::vector<results::WallForce> triangles = touchedFromMessage(message);
  ASSERT_EQ(triangles.size(), touched.size());
  for (std::size_t k = 0; k < touched.size(); ++k)
  {
    EXPECT_EQ(triangles[k].triangle, touched[k].triangle);
    EXPECT_EQ(triangles[k].region, touched[k].region);
    EXPECT_EQ(triangles[k].peak, static_cast<float>(touched[k].peak));
    EXPECT_EQ(triangles[k].peak_time, static_cast<float>(touched[k].peak_time));
    EXPECT_EQ(triangles[k].integral, static_cast<float>(touched[k].integral));
    EXPECT_EQ(triangles[k].time_over_threshold, static_cast<float>(touched[k].time_over_threshold));
  }
}

TEST(ContactForceConversions, TruncateListsOfUnequalLength)
{
  ContactForceMap message;
  toMessage(results::WallForceSummary(), std::vector<results::WallForce>(3), message);
  message.integral.resize(2);
  EXPECT_EQ(touchedFromMessage(message).size(), 2U);
}

TEST(ContactForceConversions, MapRegionsBeyondSixteenBitsToNone)
{
  EXPECT_EQ(regionFromMessage(regionToMessage(65534)), 65534);
  EXPECT_EQ(regionFromMessage(regionToMessage(65535)), results::kNoRegion);
  EXPECT_EQ(regionFromMessage(regionToMessage(70000)), results::kNoRegion);
  EXPECT_EQ(regionFromMessage(regionToMessage(results::kNoRegion)), results::kNoRegion);
}

}  // namespace
}  // namespace endovascular_sim::nodes
