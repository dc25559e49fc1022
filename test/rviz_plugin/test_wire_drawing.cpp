#include "rviz_plugin/model/wire_drawing.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "common/time/processor_time.h"

namespace endovascular_sim::rviz_plugin
{
namespace
{

SceneSummary wireInCatheter()
{
  SceneSummary scene;
  scene.instruments.resize(2);
  scene.instruments[0].shape = {"wire", false, {2.0}, {2e-4}};
  scene.instruments[1].shape = {"catheter", true, {2.0}, {1e-3}};
  return scene;
}

RodStateVisual curvedWire(std::size_t count)
{
  RodStateVisual message;
  for (std::size_t i = 0; i < count; ++i)
  {
    geometry_msgs::Point node;
    node.x = 1e-3 * static_cast<double>(i);
    node.y = 0.02 * std::sin(20.0 * node.x);
    message.nodes.push_back(node);
    message.radius.push_back(1e-3);
    message.contact_force.emplace_back();
  }
  message.insertion = {1e-3 * static_cast<double>(count), 0.5e-3 * static_cast<double>(count)};
  return message;
}

TEST(WireDrawing, DrawsTheCatheterTranslucentOverTheOpaqueWire)
{
  WireDrawing drawing;
  drawing.setScene(wireInCatheter());
  EXPECT_EQ(drawing.update(curvedWire(100), {}), "");
  EXPECT_FALSE(drawing.opaqueTriangles().empty());
  EXPECT_FALSE(drawing.translucentTriangles().empty());
  EXPECT_EQ(drawing.opaqueTriangles().size() + drawing.translucentTriangles().size(),
            drawing.surface().triangles.size());
}

TEST(WireDrawing, DrawsOneTubeBeforeTheSceneIsKnownAndForAnotherScene)
{
  WireDrawing drawing;
  EXPECT_EQ(drawing.update(curvedWire(100), {}), "");
  EXPECT_TRUE(drawing.translucentTriangles().empty());
  drawing.setScene(wireInCatheter());
  RodStateVisual message = curvedWire(100);
  message.insertion = {0.1};
  EXPECT_EQ(drawing.update(message, {}), "");
  EXPECT_FALSE(drawing.opaqueTriangles().empty());
}

TEST(WireDrawing, DrawsNothingForInvalidMessagesAndNamesTheReason)
{
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const RodStateVisual valid = curvedWire(50);
  std::vector<std::pair<std::string, RodStateVisual>> cases(6, {"not finite", valid});
  cases[0] = {"empty", {}};
  cases[1].second.nodes[20].z = nan;
  cases[2].second.radius[20] = HUGE_VAL;
  cases[3].second.contact_force[20].x = nan;
  cases[4].first = "inconsistent lengths";
  cases[4].second.radius.pop_back();
  cases[5].first = "more than 20000 nodes";
  cases[5].second.nodes.resize(20001);
  WireDrawing drawing;
  drawing.setScene(wireInCatheter());
  for (const auto& [reason, message] : cases)
  {
    EXPECT_EQ(drawing.update(valid, {}), "");
    EXPECT_EQ(drawing.update(message, {}), reason);
    EXPECT_TRUE(drawing.surface().positions.empty());
    EXPECT_TRUE(drawing.opaqueTriangles().empty() && drawing.translucentTriangles().empty());
  }
}

TEST(WireDrawing, HasTheScaleOfTheShownTimeOfARecording)
{
  WireDrawing drawing;
  visualization::WireStyle style;
  style.full_force = 0.0;
  RodStateVisual message = curvedWire(50);
  message.time = 5.0;
  message.contact_force[7].y = 0.3;
  drawing.update(message, style);
  drawing.restartScale(1.7);
  drawing.update(message, style);
  EXPECT_DOUBLE_EQ(drawing.fullForce(), 2.0);
  drawing.restartScale(0.08);  // arrives before the message of an earlier time
  drawing.update(message, style);
  message.time = 2.0;
  message.contact_force[7].y = 0.06;
  drawing.update(message, style);
  EXPECT_DOUBLE_EQ(drawing.fullForce(), 0.1);
}

TEST(WireDrawing, FollowsTheLargestForceAndBeginsAnewAfterAReset)
{
  WireDrawing drawing;
  visualization::WireStyle style;
  style.full_force = 0.0;
  RodStateVisual message = curvedWire(50);
  message.time = 5.0;
  message.contact_force[7].y = 0.3;
  drawing.update(message, style);
  EXPECT_DOUBLE_EQ(drawing.fullForce(), 0.5);
  EXPECT_DOUBLE_EQ(drawing.largestForce(), 0.3);
  message.time = 0.0;
  message.contact_force[7].y = 0.0;
  drawing.update(message, style);
  EXPECT_DOUBLE_EQ(drawing.fullForce(), 0.05);
  style.full_force = 0.2;
  drawing.update(message, style);
  EXPECT_DOUBLE_EQ(drawing.fullForce(), 0.2);
}

TEST(WireDrawing, Of1600NodesTimes12SidesTakesAtMost3MsAndDoesNotGrow)
{
  // 800 nodes with two instruments over their whole length: 1600 rings.
  RodStateVisual message = curvedWire(800);
  message.insertion = {0.8, 0.8};
  WireDrawing drawing;
  drawing.setScene(wireInCatheter());
  drawing.update(message, {});
  const std::size_t vertices = drawing.surface().positions.capacity();
  const std::size_t corners = drawing.translucentTriangles().capacity();
  double fastest = 1.0;
  for (int update = 0; update < 300; ++update)
  {
    const double begin = processorSeconds();
    drawing.update(message, {});
    fastest = std::min(fastest, processorSeconds() - begin);
  }
  EXPECT_LT(fastest, 3e-3);
  RecordProperty("fastest_microseconds", static_cast<int>(1e6 * fastest));
  message.nodes.resize(40);
  message.radius.resize(40);
  message.contact_force.resize(40);
  for (int update = 0; update < 10000; ++update)
    drawing.update(message, {});
  EXPECT_EQ(drawing.surface().positions.capacity(), vertices);
  EXPECT_EQ(drawing.translucentTriangles().capacity(), corners);
}

}  // namespace
}  // namespace endovascular_sim::rviz_plugin
