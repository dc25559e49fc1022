#include <unistd.h>

#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <limits>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <ros/ros.h>

#include "endovascular_sim/ContrastCells.h"
#include "endovascular_sim/ContrastInjection.h"
#include "endovascular_sim/ContrastState.h"
#include "endovascular_sim/InjectContrast.h"
#include "nodes/session/bag_survey.h"
#include "session/session.h"
#include "session/x_ray_run.h"
#include "test/nodes/graph_testing.h"
#include "test/nodes/simulation_client.h"
#include "test/nodes/topic_observer.h"
#include "test/nodes/x_ray_frames.h"

namespace endovascular_sim
{
namespace
{

constexpr double kMillilitre = 1e-6;  // [m³]
constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

const std::string kScene = TEST_DATA_DIR "/catheter_with_contrast.yaml";

/** Messages that have arrived. */
struct Messages
{
  std::map<std::uint64_t, ContrastState> states;  ///< by their steps
  std::size_t arrived = 0;                        ///< number of states, also of the same steps
  std::vector<ContrastInjection> injections;
  std::optional<ContrastCells> cells;
};

/** Graph with contrast medium that a client steps, and the same run in this process. */
class Contrast : public testing::Test
{
protected:
  static void SetUpTestSuite()
  {
    client_ = std::make_unique<SimulationClient>();
    reference_ = std::make_unique<session::Session>(kScene);
    run_ = std::make_unique<session::XRayRun>(reference_->world());
    frames_ = std::make_unique<XRayFrames>();
    observer_ = std::make_unique<TopicObserver>();
    observer_->subscribe<ContrastState>(nodes::names::kContrastState,
                                        [](const auto& message)
                                        {
                                          messages_.states[message.step] = message;
                                          ++messages_.arrived;
                                        });
    observer_->subscribe<ContrastInjection>(nodes::names::kContrastInjection,
                                            [](const auto& message) { messages_.injections.push_back(message); });
    observer_->subscribe<ContrastCells>(nodes::names::kContrastCells,
                                        [](const auto& message) { messages_.cells = message; });
    ASSERT_TRUE(SimulationClient::waitForServices());
    ASSERT_TRUE(waitUntil(20.0, [] { return observer_->copy(messages_.cells).has_value(); }));
    ASSERT_TRUE(waitUntil(60.0, [] { return frames_->messages().last.complete != 0; }));
  }
  static void TearDownTestSuite()
  {
    observer_.reset();
    frames_.reset();
    run_.reset();
    reference_.reset();
    client_.reset();
  }

  /** Makes steps in the graph and in this process, and compares all of their states. */
  static void step(std::uint32_t steps)
  {
    const StepSimulation::Response response = client_->step(steps);
    ASSERT_TRUE(response.success) << response.message;
    for (std::uint32_t k = 0; k < steps; ++k)
    {
      reference_->step();
      frames_->draw(*run_, *reference_);
    }
    ASSERT_EQ(response.trajectory_hash, reference_->simulation().trajectoryHash()) << "step " << response.step;
  }

  /** Compares the state of a step at which one is published: one at a multiple of 16. */
  static void expectEqualStates()
  {
    const std::uint64_t steps = reference_->simulation().steps();
    ASSERT_EQ(steps % 16, 0U);
    ASSERT_TRUE(waitUntil(20.0, [&] { return messages().states.count(steps - 1) > 0; }));
    const ContrastState state = messages().states.at(steps - 1);
    const session::ContrastState wanted = *reference_->observe().contrast();
    EXPECT_EQ(state.time, reference_->simulation().time());
    EXPECT_EQ(state.cells, wanted.cells);
    EXPECT_EQ(state.instruments, wanted.instruments);
    EXPECT_EQ(state.rate, wanted.rate);
    EXPECT_EQ(state.remaining, wanted.remaining);
    EXPECT_EQ(state.syringe, wanted.syringe);
    EXPECT_EQ(state.volume, wanted.volume);
    EXPECT_EQ(state.injected, wanted.iodine.injected);
    EXPECT_EQ(state.inside, wanted.iodine.inside);
    EXPECT_EQ(state.left, wanted.iodine.left);
  }

  static InjectContrast::Response call(double volume, double rate, double rise = 0.3, bool refill = false)
  {
    InjectContrast call;
    call.request.volume = volume;
    call.request.rate = rate;
    call.request.rise = rise;
    call.request.concentration = kNaN;
    call.request.refill = refill ? 1 : 0;
    EXPECT_TRUE(ros::service::call(ros::NodeHandle().resolveName(nodes::names::kInjectContrast), call));
    return call.response;
  }

  /** Injects in the graph and in this process. */
  static void inject(double volume, double rate, bool refill = false)
  {
    const InjectContrast::Response response = call(volume, rate, 0.3, refill);
    ASSERT_TRUE(response.success) << response.message;
    reference_->inject(reference_->scene().contrast->injection(volume, rate, 0.3), refill);
  }

  static Messages messages() { return observer_->copy(messages_); }

  static std::unique_ptr<SimulationClient> client_;
  static std::unique_ptr<session::Session> reference_;
  static std::unique_ptr<session::XRayRun> run_;
  static std::unique_ptr<XRayFrames> frames_;
  static Messages messages_;
  static std::unique_ptr<TopicObserver> observer_;
};

std::unique_ptr<SimulationClient> Contrast::client_;
std::unique_ptr<session::Session> Contrast::reference_;
std::unique_ptr<session::XRayRun> Contrast::run_;
std::unique_ptr<XRayFrames> Contrast::frames_;
Messages Contrast::messages_;
std::unique_ptr<TopicObserver> Contrast::observer_;

TEST_F(Contrast, A_WithoutAnInjectionTheStatesAreSmall)
{
  step(320);
  expectEqualStates();
  EXPECT_TRUE(messages().states.at(319).cells.empty());
  EXPECT_TRUE(messages().states.at(319).instruments.empty());
  const ContrastCells cells = *messages().cells;
  EXPECT_EQ(cells.volume, reference_->world().lumen()->volumes);
  EXPECT_EQ(cells.content_hash, reference_->world().meshHash());
  EXPECT_EQ(cells.begin.size(), cells.volume.size());
}

TEST_F(Contrast, B_RefusesWhatIsImpossibleAndChangesNothing)
{
  EXPECT_NE(call(-1e-6, 3e-6).message.find("volume is"), std::string::npos);
  EXPECT_NE(call(kNaN, 3e-6).message.find("volume is"), std::string::npos);
  EXPECT_NE(call(3e-6, 99e-6).message.find("gives at most"), std::string::npos);
  const InjectContrast::Response large = call(50e-6, 3e-6, 0.3, true);
  EXPECT_FALSE(large.success);
  EXPECT_NE(large.message.find("inject less, or refill it"), std::string::npos) << large.message;
  EXPECT_FALSE(call(3e-6, 3e-6, -1.0).success);
  step(160);
  expectEqualStates();
  EXPECT_TRUE(messages().injections.empty());
}

TEST_F(Contrast, C_AnInjectionActsFromTheNextStepOnAndFramesShowItBitForBit)
{
  const std::uint64_t before = reference_->simulation().steps();
  inject(6.0 * kMillilitre, 6.0 * kMillilitre);
  for (const std::uint32_t steps : {100, 100, 100, 100, 80})
  {
    step(steps);
    frames_->waitFor(run_->pulses().newestAt(reference_->simulation().steps()));
  }
  expectEqualStates();
  const session::ContrastState contrast = *reference_->observe().contrast();
  EXPECT_GT(contrast.iodine.inside, 0.0);
  EXPECT_GT(*std::max_element(contrast.cells.begin(), contrast.cells.end()), 50.0);
  ASSERT_EQ(messages().injections.size(), 1U);
  EXPECT_EQ(messages().injections[0].step, before);
  EXPECT_EQ(messages().injections[0].volume, 6.0 * kMillilitre);
  EXPECT_EQ(messages().injections[0].concentration, reference_->scene().contrast->concentration);
  std::size_t dsas = 0;
  EXPECT_GE(frames_->compare(dsas), 5U);
}

TEST_F(Contrast, D_ARestartedNodeOfTheFlowGoesOnWithTheMediumInIt)
{
  ASSERT_TRUE(killNode("/hemodynamics"));
  step(400);
  step(400);
  expectEqualStates();
}

TEST_F(Contrast, E_AStateSavedWithinAnInjectionContinues)
{
  const std::filesystem::path file =
      std::filesystem::temp_directory_path() / ("contrast_" + std::to_string(getpid()) + ".state");
  inject(10.0 * kMillilitre, 5.0 * kMillilitre, true);
  step(402);
  const StateFile::Response saved = client_->file("simulation/save_state", file);
  ASSERT_TRUE(saved.success) << saved.message;
  step(318);
  expectEqualStates();
  const ContrastState wanted = messages().states.at(reference_->simulation().steps() - 1);
  const std::uint64_t hash = reference_->simulation().trajectoryHash();
  ASSERT_TRUE(call(0.0, 0.0).success) << "not part of the state";
  const StateFile::Response loaded = client_->file("simulation/load_state", file);
  ASSERT_TRUE(loaded.success) << loaded.message;
  const std::size_t before = messages().arrived;
  const StepSimulation::Response response = client_->step(318);
  ASSERT_TRUE(response.success) << response.message;
  EXPECT_EQ(response.trajectory_hash, hash);
  EXPECT_TRUE(waitUntil(20.0, [&] { return messages().arrived >= before + 20; })) << "one every 16 steps";
  waitUntil(0.5, [] { return false; });
  EXPECT_EQ(messages().states.at(wanted.step).cells, wanted.cells);
  EXPECT_EQ(messages().states.at(wanted.step).syringe, wanted.syringe);
  EXPECT_EQ(messages().states.at(wanted.step).left, wanted.left);
  std::filesystem::remove(file);
}

TEST_F(Contrast, F_ACommandEndsAnInjectionAndFillsTheSyringe)
{
  ASSERT_TRUE(call(0.0, 0.0).success);
  reference_->stopInjection();
  step(80);
  expectEqualStates();
  EXPECT_EQ(reference_->observe().contrast()->remaining, 0.0);
  ASSERT_TRUE(call(0.0, 0.0, 0.0, true).success);
  reference_->refillSyringe();
  step(80);
  expectEqualStates();
  EXPECT_EQ(reference_->observe().contrast()->syringe, contrast::kHandSyringe.capacity);
}

// Must run last.
TEST_F(Contrast, G_RecordingsReplayWithTheirInjections)
{
  const std_srvs::Trigger::Response stopped = client_->trigger("session/stop");
  ASSERT_TRUE(stopped.success) << stopped.message;
  const std::filesystem::path second = std::filesystem::path(stopped.message).parent_path();
  const std::filesystem::path first = second.parent_path();
  replayedHash(first / "session.bag");
  EXPECT_EQ(replayedHash(second / "session.bag"), Hash64::toHex(reference_->simulation().trajectoryHash()));
  EXPECT_EQ(nodes::readSessionBag(first / "session.bag").injections.size(), 3U);
  const nodes::SessionBag recording = nodes::readSessionBag(second / "session.bag");
  EXPECT_EQ(recording.injections.size(), 2U);
  nodes::RecordedSimulation replayed(recording, second / "session.bag");
  nodes::replay(recording, replayed, false);
  const session::ContrastState contrast = *replayed.session().observe().contrast();
  const session::ContrastState wanted = *reference_->observe().contrast();
  EXPECT_EQ(contrast.cells, wanted.cells);
  EXPECT_EQ(contrast.volume, wanted.volume);
  EXPECT_EQ(contrast.syringe, wanted.syringe);
  EXPECT_EQ(contrast.iodine.left, wanted.iodine.left);
  const nodes::BagSurvey survey = nodes::surveyBag(second / "session.bag");
  EXPECT_GT(survey.topics.at("/contrast/state").messages, 0U);
  EXPECT_EQ(survey.topics.at("/contrast/state").messages, survey.topics.at("/rod/state_visual").messages);
  EXPECT_EQ(survey.topics.at("/contrast/cells").messages, 1U);
}

const auto* const kCallbacks = testing::AddGlobalTestEnvironment(new CallbackThread);

}  // namespace
}  // namespace endovascular_sim
