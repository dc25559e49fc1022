#include <array>
#include <cmath>
#include <limits>
#include <random>

#include <gtest/gtest.h>

#include "contact/contract/contact_set_validation.h"
#include "contact/detector.h"
#include "results/run_result.h"
#include "scene/scene_file.h"
#include "simulation/degraded/force_fault_limiter.h"
#include "simulation/instrument_tip.h"
#include "simulation/simulation.h"

// Late, duplicate, missing and invalid contact sets, injected between the detector and the solver.

namespace endovascular_sim::simulation
{
namespace
{

constexpr double kPeakShare = 0.02;        ///< largest permitted jump of the rendered force, relative to the peak [1]
constexpr int kLongestSilence = 14;        ///< longest gap without a pause, which begins at 15 ms [steps of 1 ms]
constexpr double kMostPenetration = 1e-4;  ///< [m]

/** Contact source with random faults. Sets pass the same validation as those of a remote contact node. */
class FaultySource : public contact::ContactSource
{
public:
  FaultySource(contact::ContactSource& detector, unsigned seed) : detector_(detector), random_(seed) {}

  /** @param probability probability per query of a fault [1]
   *  @param longest largest duration of a fault [steps] */
  void setFaults(double probability, int longest)
  {
    probability_ = probability;
    longest_ = longest;
  }
  /** Suppresses all sets while true. */
  void setDead(bool dead) { dead_ = dead; }

  void detect(const contact::Query& query, contact::ContactSet& set) override
  {
    contact::ContactSet answer;
    detector_.detect(query, answer);
    deliver(query, answer, set);
  }

  void freeDistances(const contact::Query& query, double wanted, contact::ContactSet& set) override
  {
    contact::ContactSet answer;
    detector_.freeDistances(query, wanted, answer);
    deliver(query, answer, set);
  }

  static constexpr int kFaults = 12;
  const std::array<int, kFaults>& dropped() const { return dropped_; }

private:
  void deliver(const contact::Query& query, contact::ContactSet answer, contact::ContactSet& set)
  {
    if (query.step != step_ && silent_steps_ > 0)
      --silent_steps_;
    step_ = query.step;
    if (silent_steps_ == 0 && share_(random_) < probability_)
    {
      silent_steps_ = 1 + static_cast<int>(share_(random_) * longest_);
      fault_ = static_cast<int>(share_(random_) * kFaults);
    }
    if (silent_steps_ > 0 || dead_)
      answer = corrupted(query, answer);
    else
      last_good_ = answer;
    if (!dead_ && contact::isValidAnswer(query, answer))
    {
      set = answer;
      set.stale = false;
      return;
    }
    ++dropped_[dead_ ? 0 : fault_];
    set.stale = true;
  }

  contact::ContactSet corrupted(const contact::Query& query, contact::ContactSet answer)
  {
    contact::Feature bad;
    bad.edge = query.first_node;
    bad.normal = Eigen::Vector3d::UnitX();
    if (answer.features.empty())
      answer.features.push_back(bad);
    contact::Feature& feature = answer.features[random_() % answer.features.size()];
    switch (fault_)
    {
      case 0:  // missing, or later than the timeout
      case 1:  // late or duplicate: the last valid set again
        return last_good_;
      case 2:
        ++answer.step;
        break;
      case 3:
        --answer.pass;
        break;
      case 4:
        feature.gap = std::nan("");
        break;
      case 5:
        feature.normal.x() = std::nan("");
        break;
      case 6:
        feature.edge = -1 - static_cast<int>(random_() % 1000);
        break;
      case 7:
        feature.edge = 1000000;
        break;
      case 8:
        answer.free_distance.resize(answer.free_distance.size() / 2);
        break;
      case 9:
        feature.point += Eigen::Vector3d(0.1, -0.2, 0.3);
        break;
      case 10:
        answer.features.resize(answer.features.size() + 7);
        break;
      default:
        feature.parameter = -std::numeric_limits<double>::infinity();
    }
    return answer;
  }

  contact::ContactSource& detector_;
  std::mt19937 random_;
  std::uniform_real_distribution<double> share_{0.0, 1.0};
  double probability_ = 0.0;
  int longest_ = 1;
  int silent_steps_ = 0;
  int fault_ = 0;
  bool dead_ = false;
  std::uint64_t step_ = ~std::uint64_t{0};
  contact::ContactSet last_good_;
  std::array<int, kFaults> dropped_ = {};
};

/** Simulation of a scene with a faulty contact source, and its rendered force. */
struct Bench
{
  Bench(const std::string& name, unsigned seed, const std::vector<std::string>& overrides = {})
    : scene(scene::loadScene(PROJECT_DIR "/config/scenes/" + name, overrides)),
      vessel(scene::buildVessel(*scene.vessel, scene.entry, scene.file)),
      detector(vessel.mesh, scene::wallLaw(*scene.vessel)),
      source(detector, seed),
      simulation(scene, scene::resolveEntry(scene.entry, vessel, scene.file), &source)
  {
  }

  void step()
  {
    const double dt = scene.solver.time_step;
    const double end = static_cast<double>(simulation.steps() + 1) * dt;
    simulation.step(
        {scene.instruments.front().drive.insertionAt(end), scene.instruments.front().drive.rotationAt(end)});
    const bool stale = simulation.report().first_stale_pass != contact::kNoStalePass;
    rendered = limiter.filter(simulation.state().hand_force, stale, dt);
    stale_steps += stale;
  }

  /** Reports whether the limiter has changed the force of the last step. */
  bool isLimited() const { return rendered != simulation.state().hand_force; }

  void expectSane() const
  {
    ASSERT_TRUE(simulation.report().solved) << "step " << simulation.steps();
    ASSERT_LT(simulation.report().max_strain, 1e-3) << "step " << simulation.steps();
    ASSERT_LE(simulation.surfacePenetration(), kMostPenetration) << "step " << simulation.steps();
    ASSERT_TRUE(std::isfinite(rendered) && std::isfinite(simulation.state().hand_torque));
  }

  void expectInside() const
  {
    for (int i = simulation::firstInsertedNode(simulation); i < simulation.discretisation().nodes(); ++i)
      ASSERT_GT(detector.signedDistance(simulation.state().position[i]), 0.0)
          << "node " << i << ", step " << simulation.steps();
  }

  scene::Scene scene;
  vessel::Vessel vessel;
  contact::Detector detector;
  FaultySource source;
  Simulation simulation;
  ForceFaultLimiter limiter{5e-3};
  double rendered = 0.0;  ///< force after the limiter [N]
  int stale_steps = 0;
};

/** Largest force and largest change of it from one step to the next [N]. */
struct Jumps
{
  double peak = 0.0;
  double largest = 0.0;
  double before = 0.0;

  void add(double force)
  {
    peak = std::max(peak, std::abs(force));
    largest = std::max(largest, std::abs(force - before));
    before = force;
  }
};

/** Compares the jumps of the rendered force with and without faults. */
void expectNoJumps(const std::string& name, int steps, double probability, int longest, unsigned seed)
{
  Bench intact(name, seed);
  Bench faulty(name, seed);
  Jumps without;
  Jumps with;
  double limited = 0.0;  ///< largest jump in steps with a limited force [N]
  int limited_steps = 0;
  faulty.source.setFaults(probability, longest);
  for (int k = 0; k < steps; ++k)
  {
    intact.step();
    faulty.step();
    without.add(intact.rendered);
    const double before = with.before;
    with.add(faulty.rendered);
    if (faulty.isLimited())
    {
      limited = std::max(limited, std::abs(faulty.rendered - before));
      ++limited_steps;
    }
    faulty.expectSane();
    if (testing::Test::HasFatalFailure())
      return;
    if (k % 500 == 0)
      faulty.expectInside();
  }
  faulty.expectInside();
  EXPECT_GT(without.peak, 0.0);
  EXPECT_GT(faulty.stale_steps, steps / 200) << "faults occurred";
  EXPECT_EQ(intact.stale_steps, 0);
  EXPECT_GT(limited_steps, faulty.stale_steps);
  EXPECT_LE(limited, kPeakShare * without.peak);
  // Unlimited jumps are those of the scene, on a trajectory that the faults have changed slightly.
  EXPECT_LE(with.largest, 1.5 * without.largest);
  EXPECT_LE(with.peak, 1.5 * without.peak);
  for (const int dropped : faulty.source.dropped())
    EXPECT_GT(dropped, 0) << "every kind of fault occurred";
}

TEST(ContactFaults, ASingleInvalidSetCausesNoForceJumpInABentTube)
{
  expectNoJumps("tube.yaml", 3500, 0.05, 1, 1);
}

TEST(ContactFaults, GapsUpToThePauseCauseNoForceJumpInABentTube)
{
  for (const unsigned seed : {1U, 2U, 3U})
    expectNoJumps("tube.yaml", 3500, 0.04, kLongestSilence, seed);
}

TEST(ContactFaults, GapsCauseNoForceJumpInTheAorta)
{
  expectNoJumps("demo.yaml", 9000, 0.02, kLongestSilence, 1);
}

TEST(ContactFaults, ValidationWithoutFaultsChangesNoBits)
{
  Bench checked("tube.yaml", 1);
  contact::Detector detector(checked.vessel.mesh, scene::wallLaw(*checked.scene.vessel));
  Simulation direct(checked.scene, scene::resolveEntry(checked.scene.entry, checked.vessel, checked.scene.file),
                    &detector);
  for (int k = 0; k < 3000; ++k)
  {
    checked.step();
    const double end = static_cast<double>(direct.steps() + 1) * checked.scene.solver.time_step;
    direct.step({checked.scene.instruments.front().drive.insertionAt(end),
                 checked.scene.instruments.front().drive.rotationAt(end)});
    ASSERT_EQ(checked.rendered, direct.state().hand_force) << "the limiter does not change it";
  }
  EXPECT_EQ(checked.simulation.trajectoryHash(), direct.trajectoryHash());
  EXPECT_EQ(checked.stale_steps, 0);
}

TEST(ContactFaults, InsertionSlowsWithStaleSetsAndCatchesUpCompletely)
{
  Bench bench("tube.yaml", 1, {"drive.travel=0.06"});
  for (int k = 0; k < 1000; ++k)
    bench.step();
  const double before = bench.simulation.state().inserted_length;
  bench.source.setDead(true);
  for (int k = 0; k < kLongestSilence; ++k)
    bench.step();
  EXPECT_GT(bench.simulation.state().inserted_length, before) << "insertion continues";
  EXPECT_LE(bench.simulation.state().inserted_length - before, bench.scene.solver.stepper.contact_margin + 0.06e-3)
      << "insertion ends with the cover of the last set, apart from the step that began with a fresh set";
  bench.source.setDead(false);
  double fastest = 0.0;
  double last = bench.simulation.state().inserted_length;
  while (bench.simulation.time() < 2.9)
  {
    bench.step();
    const double moved = bench.simulation.state().inserted_length - last;
    EXPECT_GE(moved, -1e-12) << "insertion is monotonic";
    fastest = std::max(fastest, moved);
    last += moved;
  }
  EXPECT_LT(fastest, 1.6 * bench.scene.instruments.front().drive.speed * bench.scene.solver.time_step);
  EXPECT_NEAR(last, bench.scene.instruments.front().drive.insertionAt(2.9), 1e-6);
}

TEST(ContactFaults, ForceReturnsFromZeroWithoutAJumpAfterAPause)
{
  Bench bench("tube.yaml", 1);
  Jumps jumps;
  for (int k = 0; k < 2800; ++k)
  {
    bench.step();
    jumps.add(bench.rendered);
  }
  bench.source.setDead(true);
  for (int k = 0; k < 15; ++k)
    bench.step();
  // As the rod node after its ramp, when the contact node responds again.
  bench.limiter.reset();
  bench.source.setDead(false);
  Jumps after;
  double met = 0.0;
  for (int k = 0; k < 400; ++k)
  {
    bench.step();
    after.add(bench.rendered);
    bench.expectSane();
    if (met == 0.0 && !bench.isLimited())
      met = 1e-3 * k;
  }
  EXPECT_LE(after.largest, jumps.largest + kPeakShare * jumps.peak);
  EXPECT_GT(met, 0.0);
  EXPECT_LE(met, 0.2) << "the rendered force equals that of the simulation within 0.2 s";
  EXPECT_EQ(bench.rendered, bench.simulation.state().hand_force);
}

TEST(ContactFaults, StateStaysFiniteUnderManyKindsOfFaults)
{
  Bench bench("tube.yaml", 9, {"drive.speed=0.2", "vessel.friction=0.3"});
  bench.source.setFaults(0.2, kLongestSilence);
  for (int k = 0; k < 3000; ++k)
  {
    bench.step();
    ASSERT_TRUE(std::isfinite(bench.rendered));
    if (k % 500 == 0)
      bench.expectInside();
  }
  bench.expectInside();
}

}  // namespace
}  // namespace endovascular_sim::simulation
