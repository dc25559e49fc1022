#include "nodes/conversions/contrast_conversions.h"

#include <functional>
#include <limits>

#include <gtest/gtest.h>

#include "common/error.h"
#include "scene/scene_file.h"
#include "session/session.h"

namespace endovascular_sim::nodes
{
namespace
{

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

ContrastInjection messageOf(const simulation::ContrastInput& input)
{
  ContrastInjection message;
  toMessage(input, message);
  return message;
}

TEST(ContrastConversions, InjectionsKeepTheirBits)
{
  const simulation::ContrastInput before{
      12345678901, {10e-6 / 3.0, 4e-6 / 3.0, 0.1 / 3.0, 1000.0 / 3.0, 0.031 / 3.0}, true};
  const simulation::ContrastInput after = fromMessage(messageOf(before));
  EXPECT_EQ(after.step, before.step);
  EXPECT_EQ(after.injection.volume, before.injection.volume);
  EXPECT_EQ(after.injection.rate, before.injection.rate);
  EXPECT_EQ(after.injection.rise, before.injection.rise);
  EXPECT_EQ(after.injection.concentration, before.injection.concentration);
  EXPECT_EQ(after.injection.viscosity, before.injection.viscosity);
  EXPECT_TRUE(after.refill);
}

TEST(ContrastConversions, AVolumeOfZeroEndsAnInjection)
{
  const simulation::ContrastInput end = fromMessage(messageOf({7, {}, false}));
  EXPECT_EQ(end.injection.volume, 0.0);
  EXPECT_FALSE(end.refill);
  EXPECT_NE(textOf(end).find("ends"), std::string::npos);
  EXPECT_NE(textOf({7, {}, true}).find("the syringe is full"), std::string::npos);
}

TEST(ContrastConversions, ImpossibleInjectionsAreRefused)
{
  const auto isRefused = [](const std::function<void(ContrastInjection&)>& damage)
  {
    ContrastInjection message = messageOf({7, {6e-6, 4e-6, 0.3, 350.0, 10.4e-3}, false});
    fromMessage(message);
    damage(message);
    EXPECT_THROW(fromMessage(message), InputError);
  };
  isRefused([](ContrastInjection& message) { message.volume = -1e-6; });
  isRefused([](ContrastInjection& message) { message.volume = kNaN; });
  isRefused([](ContrastInjection& message) { message.volume = 1.0; });
  isRefused([](ContrastInjection& message) { message.rate = 0.0; });
  isRefused([](ContrastInjection& message) { message.rise = -1.0; });
  isRefused([](ContrastInjection& message) { message.concentration = 500.0; });
  isRefused([](ContrastInjection& message) { message.viscosity = kNaN; });
}

TEST(ContrastConversions, ACallHasTheMediumOfTheSceneOrItsOwn)
{
  InjectContrast::Request request;
  request.volume = 6e-6;
  request.rate = 4e-6;
  request.rise = 0.3;
  request.concentration = kNaN;
  scene::ContrastScene scene;
  EXPECT_EQ(injectionOf(request, scene).concentration, scene.concentration);
  EXPECT_EQ(injectionOf(request, scene).viscosity, scene.viscosity);
  request.concentration = 300.0;
  EXPECT_EQ(injectionOf(request, scene).concentration, 300.0);
  EXPECT_LT(injectionOf(request, scene).viscosity, scene.viscosity);
  EXPECT_EQ(textOf({0, injectionOf(request, scene), false}), "injects 6 ml at 4 ml/s of 300 mgI/ml");
}

TEST(ContrastConversions, AStateIsThatOfTheSimulation)
{
  session::Session session(TEST_DATA_DIR "/catheter_with_contrast.yaml");
  session.step(20);
  ContrastState message;
  toMessage(session.simulation(), message);
  EXPECT_TRUE(mediumOf(message).cells.empty());
  session.inject(session.scene().contrast->injection(6e-6, 6e-6, 0.0));
  session.step(40);
  toMessage(session.simulation(), message);
  const session::ContrastState wanted = *session.observe().contrast();
  ASSERT_FALSE(wanted.cells.empty());
  EXPECT_EQ(message.step, 59U);
  EXPECT_EQ(message.time, session.simulation().time());
  EXPECT_EQ(mediumOf(message).cells, wanted.cells);
  EXPECT_EQ(mediumOf(message).instruments, wanted.instruments);
  EXPECT_EQ(message.rate, wanted.rate);
  EXPECT_EQ(message.remaining, wanted.remaining);
  EXPECT_EQ(message.syringe, wanted.syringe);
  EXPECT_EQ(message.volume, wanted.volume);
  EXPECT_EQ(message.injected, wanted.iodine.injected);
  EXPECT_EQ(message.inside, wanted.iodine.inside);
  EXPECT_EQ(message.left, wanted.iodine.left);
}

TEST(ContrastConversions, StatesWithImpossibleNumbersAreRefused)
{
  ContrastState message;
  message.cells = {1.0, -1.0};
  EXPECT_THROW(mediumOf(message), InputError);
  message.cells = {1.0, kNaN};
  EXPECT_THROW(mediumOf(message), InputError);
  message.cells = {1.0, 0.0};
  message.instruments = {std::numeric_limits<double>::infinity()};
  EXPECT_THROW(mediumOf(message), InputError);
}

TEST(ContrastConversions, VolumesOfCellsKeepTheirBits)
{
  vessel::CentrelineTree centreline;
  centreline.branches.resize(2);
  centreline.branches[1].name = "aorta";
  const contrast::ContrastCells cells = {{0, 0.0, 1e-2 / 3.0, -1}, {1, 0.1, 0.2, 0}};
  ContrastCells message;
  toMessage(cells, {1e-6 / 3.0, 2e-6}, centreline, message);
  EXPECT_EQ(volumesOf(message), (std::vector<double>{1e-6 / 3.0, 2e-6}));
  EXPECT_EQ(message.branch_name, (std::vector<std::string>{"", "aorta"}));
  EXPECT_EQ(message.branch[1], 1U);
  EXPECT_EQ(message.begin[1], 0.1);
  EXPECT_EQ(message.end[0], 1e-2 / 3.0);
  message.volume[1] = 0.0;
  EXPECT_THROW(volumesOf(message), InputError);
  message.volume.pop_back();
  EXPECT_THROW(volumesOf(message), InputError);
}

}  // namespace
}  // namespace endovascular_sim::nodes
