#include <memory>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <ros/ros.h>

#include "endovascular_sim/CArm.h"
#include "endovascular_sim/SetXRayMode.h"
#include "session/session.h"
#include "session/x_ray_run.h"
#include "test/nodes/graph_testing.h"
#include "test/nodes/simulation_client.h"
#include "test/nodes/x_ray_frames.h"

namespace endovascular_sim
{
namespace
{

constexpr double kPatience = 100.0;  // the body of a new vessel takes seconds of processor time [s]

const std::vector<std::string> kOverrides = {"fluoroscopy.pixels=96", "fluoroscopy.follow_tip=false",
                                             "fluoroscopy.isocentre=[0.03,-0.05,0.16]", "fluoroscopy.patient.body=true",
                                             "fluoroscopy.primary_angle=0.7"};

/** Graph that a client steps, and the same run in this process. */
class Angiography : public testing::Test
{
protected:
  static void SetUpTestSuite()
  {
    client_ = std::make_unique<SimulationClient>();
    reference_ = std::make_unique<session::Session>(TEST_DATA_DIR "/catheter_in_motion.yaml", kOverrides);
    frames_ = std::make_unique<XRayFrames>();
    ASSERT_TRUE(SimulationClient::waitForServices());
    ASSERT_TRUE(waitUntil(kPatience, [] { return messages().last.complete != 0; }));
  }
  static void TearDownTestSuite()
  {
    frames_.reset();
    reference_.reset();
    client_.reset();
  }

  /** Makes steps in the graph and in this process, where a run draws every pulse. */
  static void step(std::uint32_t steps, session::XRayRun& run)
  {
    const StepSimulation::Response response = client_->step(steps);
    ASSERT_TRUE(response.success) << response.message;
    for (std::uint32_t k = 0; k < steps; ++k)
    {
      reference_->step();
      frames_->draw(run, *reference_);
    }
    ASSERT_EQ(response.trajectory_hash, reference_->simulation().trajectoryHash());
    frames_->waitFor(run.pulses().newestAt(reference_->simulation().steps()));
  }

  static SetXRayMode::Response set(const std::string& mode, std::uint32_t mask_frames = 0)
  {
    SetXRayMode call;
    call.request.mode = mode;
    call.request.mask_frames = mask_frames;
    EXPECT_TRUE(ros::service::call(ros::NodeHandle().resolveName(nodes::names::kSetXRayMode), call));
    return call.response;
  }

  static XRayFrames::Messages messages() { return frames_->messages(); }

  static std::unique_ptr<SimulationClient> client_;
  static std::unique_ptr<session::Session> reference_;
  static std::unique_ptr<XRayFrames> frames_;
};

std::unique_ptr<SimulationClient> Angiography::client_;
std::unique_ptr<session::Session> Angiography::reference_;
std::unique_ptr<XRayFrames> Angiography::frames_;

TEST_F(Angiography, A_LiveFramesOfTheGraphHaveTheBitsOfARunOffline)
{
  session::XRayRun run(reference_->world());
  frames_->clear();
  for (const std::uint32_t steps : {67, 67, 100, 1000, 150})  // in the thousand most pulses are left out
    step(steps, run);
  std::size_t dsas = 0;
  EXPECT_GE(frames_->compare(dsas), 5U);
  EXPECT_EQ(dsas, 0U);
}

TEST_F(Angiography, B_RefusesWhatIsImpossibleWithARemedy)
{
  EXPECT_FALSE(set("dsa").success);
  EXPECT_NE(set("dsa").message.find("give mask_frames of 1 or more"), std::string::npos);
  EXPECT_NE(set("roadmap").message.find("needs a DSA run"), std::string::npos);
  EXPECT_NE(set("DSA", 2).message.find("unknown mode 'DSA'"), std::string::npos);
  EXPECT_NE(set("dsa", 4000000000U).message.find("must lie between 0 and 64"), std::string::npos);
}

TEST_F(Angiography, C_SubtractedFramesHaveTheBitsOfARunOffline)
{
  const SetXRayMode::Response response = set("dsa", 3);
  ASSERT_TRUE(response.success) << response.message;
  session::XRayRunSettings settings;
  settings.mask_frames = 3;
  session::XRayRun run(reference_->world(), settings);
  frames_->clear();
  for (const std::uint32_t steps : {300, 67, 500, 70})
    step(steps, run);
  std::size_t dsas = 0;
  EXPECT_GE(frames_->compare(dsas), 5U);
  EXPECT_GE(dsas, 3U);
  EXPECT_EQ(messages().last.mask, "valid");
}

TEST_F(Angiography, D_AMotionOfTheCArmMakesTheMaskInvalid)
{
  ros::NodeHandle node;
  const ros::Publisher c_arm = node.advertise<CArm>(nodes::names::kCArmCommand, 1);
  ASSERT_TRUE(waitUntil(20.0, [&] { return c_arm.getNumSubscribers() > 0; }));
  CArm command;
  command.view = "LAO 42";
  c_arm.publish(command);
  ASSERT_TRUE(waitUntil(20.0, [] { return messages().last.mask == "invalid"; }));
  EXPECT_EQ(messages().last.remark, "the C-arm has moved since the mask was taken; take a new one");
}

TEST_F(Angiography, E_HoldShowsTheLastImage)
{
  const XRayFrames::Messages before = messages();
  ASSERT_TRUE(set("hold").success);
  ASSERT_TRUE(waitUntil(20.0, [] { return messages().last.mode == "hold"; }));
  EXPECT_EQ(messages().last.pulse, before.last.pulse);
  EXPECT_TRUE(client_->step(200).success);
  waitUntil(1.0, [] { return false; });
  EXPECT_EQ(messages().last.pulse, before.last.pulse);
  ASSERT_TRUE(set("live").success);
  EXPECT_TRUE(waitUntil(20.0, [&] { return messages().last.pulse > before.last.pulse; }));
}

}  // namespace
}  // namespace endovascular_sim
