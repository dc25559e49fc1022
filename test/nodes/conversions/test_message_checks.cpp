#include "nodes/conversions/message_checks.h"

#include <functional>
#include <limits>

#include <gtest/gtest.h>

#include "common/error.h"

namespace endovascular_sim::nodes
{
namespace
{

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kMargin = 0.01;  // m

RodState query()
{
  RodState state;
  state.nodes.resize(3);
  state.radius.assign(3, 4e-4);
  state.margin.assign(3, 1e-3);
  return state;
}

RodStateVisual visual()
{
  RodStateVisual state;
  state.nodes.resize(3);
  state.radius.assign(3, 4e-4);
  state.contact_force.resize(3);
  for (auto* values :
       {&state.insertion, &state.rotation, &state.tip_rotation, &state.hand_force, &state.hand_torque, &state.pressure})
    values->assign(2, 0.0);
  return state;
}

ContactForceMap forceMap()
{
  ContactForceMap map;
  map.triangles = {7, 9};
  map.triangle_regions = {0, 1};
  for (auto* values : {&map.peak, &map.peak_time, &map.integral, &map.time_over_threshold})
    values->assign(2, 1.0F);
  return map;
}

/** Expects that a valid message passes, and no changed one. */
template <typename Message>
void expectRefused(const Message& valid, const std::function<void(const Message&)>& check,
                   const std::vector<std::function<void(Message&)>>& changes)
{
  EXPECT_NO_THROW(check(valid));
  for (std::size_t k = 0; k < changes.size(); ++k)
  {
    Message message = valid;
    changes[k](message);
    EXPECT_THROW(check(message), InputError) << "change " << k;
  }
}

TEST(MessageChecks, RefuseAQueryThatNoSolverAsks)
{
  expectRefused<RodState>(
      query(), [](const RodState& state) { requireUsable(state, kMargin); },
      {[](RodState& state) { state.radius.pop_back(); }, [](RodState& state) { state.margin.clear(); },
       [](RodState& state) { state.nodes[1].y = kNan; }, [](RodState& state) { state.nodes[2].z = 1e300; },
       [](RodState& state) { state.radius[0] = -1.0; }, [](RodState& state) { state.margin[0] = 1.0; },
       [](RodState& state) { state.margin[2] = kNan; }, [](RodState& state) { state.wanted_free_distance = kNan; },
       [](RodState& state) { state.first_node = 0xffffffffU; }});
}

TEST(MessageChecks, AcceptAQueryOfAWireThatIsPulledOut)
{
  EXPECT_NO_THROW(requireUsable(RodState(), kMargin));
}

TEST(MessageChecks, RefuseAnIncompleteStateOfTheWire)
{
  expectRefused<RodStateVisual>(
      visual(), [](const RodStateVisual& state) { requireUsable(state, 2); },
      {[](RodStateVisual& state) { state.rotation.clear(); }, [](RodStateVisual& state) { state.tip_rotation.clear(); },
       [](RodStateVisual& state) { state.tip_rotation[0] = kNan; },
       [](RodStateVisual& state) { state.hand_force.pop_back(); },
       [](RodStateVisual& state) { state.pressure.push_back(0.0); },
       [](RodStateVisual& state) { state.insertion[0] = kNan; },
       [](RodStateVisual& state) { state.contact_force.pop_back(); },
       [](RodStateVisual& state) { state.contact_force[0].x = kNan; }, [](RodStateVisual& state) { state.time = kNan; },
       [](RodStateVisual& state) { state.radius[1] = kNan; }});
}

TEST(MessageChecks, RefuseAMapWithListsOfDifferentLengths)
{
  expectRefused<ContactForceMap>(
      forceMap(), [](const ContactForceMap& map) { requireUsable(map); },
      {[](ContactForceMap& map) { map.peak.clear(); }, [](ContactForceMap& map) { map.triangles.push_back(1); },
       [](ContactForceMap& map) { map.integral[0] = std::numeric_limits<float>::infinity(); },
       [](ContactForceMap& map) { map.whole.peak_sum = kNan; }, [](ContactForceMap& map) { map.threshold = kNan; }});
}

TEST(MessageChecks, RefuseAppliedCommandsOfAnotherScene)
{
  DriveApplied drive;
  for (auto* values : {&drive.insertion, &drive.rotation, &drive.pressure, &drive.hand_force, &drive.hand_torque})
    values->assign(1, 0.0);
  expectRefused<DriveApplied>(drive, [](const DriveApplied& applied) { requireUsable(applied, 1); },
                              {[](DriveApplied& applied) { applied.insertion.push_back(0.0); },
                               [](DriveApplied& applied) { applied.hand_torque.clear(); },
                               [](DriveApplied& applied) { applied.rotation[0] = kNan; }});
}

TEST(MessageChecks, RefuseAnImageWithoutItsPixels)
{
  sensor_msgs::Image image;
  image.width = image.height = image.step = 4;
  image.data.resize(16);
  expectRefused<sensor_msgs::Image>(image, [](const sensor_msgs::Image& checked) { requireUsable(checked); },
                                    {[](sensor_msgs::Image& changed) { changed.data.pop_back(); },
                                     [](sensor_msgs::Image& changed) { changed.width = 0; },
                                     [](sensor_msgs::Image& changed) { changed.height = 0xffffffffU; },
                                     [](sensor_msgs::Image& changed) { changed.step = 2; }});
}

TEST(MessageChecks, RefuseABodyThatNoInstrumentCarries)
{
  std::vector<geometry_msgs::Point> axis(2);
  axis[1].z = 0.02;
  EXPECT_NO_THROW(roundBody(axis, {1e-3, 1e-3}, "topic"));
  EXPECT_THROW(roundBody(axis, {1e-3, kNan}, "topic"), InputError);
  axis[1].z = 0.0;
  EXPECT_THROW(roundBody(axis, {1e-3, 1e-3}, "topic"), InputError) << "no length";
  axis[1].z = 500.0;
  EXPECT_THROW(roundBody(axis, {1e-3, 1e-3}, "topic"), InputError) << "a stent of a million rings";
}

}  // namespace
}  // namespace endovascular_sim::nodes
