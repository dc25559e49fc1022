#include <gtest/gtest.h>

#include <functional>
#include <limits>

#include "common/error.h"
#include "nodes/conversions/flow_conversions.h"
#include "nodes/runtime/line/message_frame.h"

namespace endovascular_sim::nodes
{
namespace
{

constexpr std::size_t kBranches = 3;

flow::FlowRequest request()
{
  flow::FlowRequest request;
  request.step = 12345678901;
  request.controls = {1.1, 12.4e3, true};
  request.lumens = {{2, {0.01, 0.02, 0.03}, {1e-6, 0.3e-6, 1.0 / 3.0 * 1e-6}}, {0, {}, {}}};
  request.instruments = {{1, 0.0, 0.1, 0.35e-3}, {2, 0.01, 1.0 / 3.0, 0.9e-3}};
  request.probes = {{1, 0.05}, {-1, 0.0}};
  request.injection = {2e-8 / 3.0, 350.0, 10.4e-3, {{{1, 0.05 / 3.0}, 1.0}, {{-1, 0.0}, 1.0 / 3.0}}};
  request.state = std::string("\0\x01\xff state", 9);
  return request;
}

flow::FlowAnswer answer()
{
  flow::FlowAnswer answer;
  answer.step = 7;
  answer.field.phase = 1.0 / 3.0;
  answer.field.beats = 9;
  answer.field.ventricle = 1234.5;
  answer.field.pressures = {12e3, 11e3 / 3.0};
  answer.field.flows = {1e-5 / 3.0};
  answer.field.areas = {1e-6};
  answer.field.probes = {12e3, 0.0};
  answer.field.readings = {11.9e3};
  answer.field.means = {12.1e3, {12.0e3}, {9e3}, true};
  answer.field.iodine = {0.0, 350.0 / 3.0};
  answer.field.totals = {3e-3 / 7.0, 2e-3 / 7.0, 1e-3 / 7.0};
  answer.state = std::string("\0\x02", 2);
  return answer;
}

/** Message after its way over a line. */
template <typename Message>
Message sent(const Message& message)
{
  std::vector<std::uint8_t> frame;
  toFrame(message, frame);
  Message arrived;
  fromFrame(frame.data(), static_cast<std::uint32_t>(frame.size()), arrived);
  return arrived;
}

TEST(FlowConversions, RequestsKeepTheirBits)
{
  const flow::FlowRequest before = request();
  FlowRequest message;
  toMessage(before, message);
  flow::FlowRequest after;
  fromMessage(sent(message), kBranches, after);
  EXPECT_EQ(after.step, before.step);
  EXPECT_EQ(after.controls, before.controls);
  ASSERT_EQ(after.lumens.size(), 2U);
  EXPECT_EQ(after.lumens[0].branch, 2);
  EXPECT_EQ(after.lumens[0].arcs, before.lumens[0].arcs);
  EXPECT_EQ(after.lumens[0].areas, before.lumens[0].areas);
  ASSERT_EQ(after.instruments.size(), 2U);
  EXPECT_EQ(after.instruments[1].branch, 2);
  EXPECT_EQ(after.instruments[1].begin, before.instruments[1].begin);
  EXPECT_EQ(after.instruments[1].end, before.instruments[1].end);
  EXPECT_EQ(after.instruments[1].radius, before.instruments[1].radius);
  ASSERT_EQ(after.probes.size(), 2U);
  EXPECT_EQ(after.probes[0].branch, 1);
  EXPECT_EQ(after.probes[0].arc, before.probes[0].arc);
  EXPECT_EQ(after.probes[1].branch, -1);
  EXPECT_EQ(after.injection.volume, before.injection.volume);
  EXPECT_EQ(after.injection.concentration, before.injection.concentration);
  EXPECT_EQ(after.injection.viscosity, before.injection.viscosity);
  ASSERT_EQ(after.injection.openings.size(), 2U);
  EXPECT_EQ(after.injection.openings[0].place.branch, 1);
  EXPECT_EQ(after.injection.openings[0].place.arc, before.injection.openings[0].place.arc);
  EXPECT_EQ(after.injection.openings[1].place.branch, -1);
  EXPECT_EQ(after.injection.openings[1].share, before.injection.openings[1].share);
  EXPECT_EQ(after.state, before.state);
}

TEST(FlowConversions, AnswersKeepTheirBits)
{
  const flow::FlowAnswer before = answer();
  FlowAnswer message;
  toMessage(before, message);
  flow::FlowAnswer after;
  fromMessage(sent(message), after);
  EXPECT_EQ(after.step, before.step);
  EXPECT_EQ(after.field.phase, before.field.phase);
  EXPECT_EQ(after.field.beats, before.field.beats);
  EXPECT_EQ(after.field.ventricle, before.field.ventricle);
  EXPECT_EQ(after.field.pressures, before.field.pressures);
  EXPECT_EQ(after.field.flows, before.field.flows);
  EXPECT_EQ(after.field.areas, before.field.areas);
  EXPECT_EQ(after.field.probes, before.field.probes);
  EXPECT_EQ(after.field.readings, before.field.readings);
  EXPECT_EQ(after.field.means.root, before.field.means.root);
  EXPECT_EQ(after.field.means.readings, before.field.means.readings);
  EXPECT_EQ(after.field.means.lesions, before.field.means.lesions);
  EXPECT_EQ(after.field.means.hyperaemia, before.field.means.hyperaemia);
  EXPECT_EQ(after.field.iodine, before.field.iodine);
  EXPECT_EQ(after.field.totals.injected, before.field.totals.injected);
  EXPECT_EQ(after.field.totals.inside, before.field.totals.inside);
  EXPECT_EQ(after.field.totals.left, before.field.totals.left);
  EXPECT_EQ(after.state, before.state);
}

TEST(FlowConversions, ControlsKeepTheirBits)
{
  const flow::FlowControls before{4.0 / 3.0, 12.4e3 / 3.0, true};
  HemodynamicControls message;
  toMessage(before, message);
  EXPECT_EQ(fromMessage(sent(message)), before);
  message.heart_rate = 50.0;
  EXPECT_THROW(fromMessage(message), InputError);
}

TEST(FlowConversions, ImpossibleRequestsAreRefused)
{
  const auto isRefused = [](const std::function<void(FlowRequest&)>& damage)
  {
    FlowRequest message;
    toMessage(request(), message);
    damage(message);
    flow::FlowRequest read;
    EXPECT_THROW(fromMessage(message, kBranches, read), InputError);
  };
  constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
  isRefused([](FlowRequest& message) { message.heart_rate = kNaN; });
  isRefused([](FlowRequest& message) { message.mean_pressure = -1.0; });
  isRefused([](FlowRequest& message) { message.lumens[0].branch = kBranches; });
  isRefused([](FlowRequest& message) { message.lumens[0].areas.pop_back(); });
  isRefused([](FlowRequest& message) { message.lumens[0].areas[1] = -1e-6; });
  isRefused([](FlowRequest& message) { std::swap(message.lumens[0].arcs[0], message.lumens[0].arcs[2]); });
  isRefused([](FlowRequest& message) { message.instruments[0].branch = 4000000000U; });
  isRefused([](FlowRequest& message) { message.instruments[0].radius = kNaN; });
  isRefused([](FlowRequest& message) { message.probes[0].branch = kBranches; });
  isRefused([](FlowRequest& message) { message.probes[0].arc = kNaN; });
  isRefused([](FlowRequest& message) { message.injected_volume = kNaN; });
  isRefused([](FlowRequest& message) { message.injected_volume = -1e-9; });
  isRefused([](FlowRequest& message) { message.injected_viscosity = std::numeric_limits<double>::infinity(); });
  isRefused([](FlowRequest& message) { message.openings[0].branch = kBranches; });
  isRefused([](FlowRequest& message) { message.openings.pop_back(); });
  isRefused([](FlowRequest& message) { message.opening_shares[0] = 0.0; });
  isRefused([](FlowRequest& message) { message.opening_shares[0] = kNaN; });
}

TEST(FlowConversions, AnswersWithNumbersThatAreNotFiniteAreRefused)
{
  const auto isRefused = [](const std::function<void(FlowAnswer&)>& damage)
  {
    FlowAnswer message;
    toMessage(answer(), message);
    damage(message);
    flow::FlowAnswer read;
    EXPECT_THROW(fromMessage(message, read), InputError);
  };
  constexpr double kInfinite = std::numeric_limits<double>::infinity();
  isRefused([](FlowAnswer& message) { message.phase = kInfinite; });
  isRefused([](FlowAnswer& message) { message.pressure[1] = kInfinite; });
  isRefused([](FlowAnswer& message) { message.flow[0] = kInfinite; });
  isRefused([](FlowAnswer& message) { message.readings[0] = kInfinite; });
  isRefused([](FlowAnswer& message) { message.iodine[0] = kInfinite; });
  isRefused([](FlowAnswer& message) { message.iodine_left = kInfinite; });
}

}  // namespace
}  // namespace endovascular_sim::nodes
