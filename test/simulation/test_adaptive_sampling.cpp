#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "contact/detector.h"
#include "results/run_result.h"
#include "scene/scene_file.h"
#include "simulation/instrument_tip.h"
#include "simulation/replay_source.h"
#include "simulation/simulation.h"

namespace endovascular_sim::simulation
{
namespace
{

const std::string kTube = std::string(PROJECT_DIR) + "/config/scenes/tube.yaml";

/** Wire in the bent tube, driven by the test. */
struct Bench
{
  explicit Bench(const std::vector<std::string>& overrides = {"sampling={kind: adaptive}"})
    : scene(scene::loadScene(kTube, overrides)),
      vessel(scene::buildVessel(*scene.vessel, scene.entry, scene.file, scene::centrelineUse(scene))),
      detector(vessel.mesh, scene::wallLaw(*scene.vessel)),
      source(detector),
      simulation(scene, scene::resolveEntry(scene.entry, vessel, scene.file), &source, &vessel.centreline)
  {
  }

  void step()
  {
    const double end = static_cast<double>(simulation.steps() + 1) * scene.solver.time_step;
    simulation.step(
        {scene.instruments.front().drive.insertionAt(end), scene.instruments.front().drive.rotationAt(end)});
  }

  /** Arc length of an edge's beginning from the introducer [m]. */
  double beyond(int node) const
  {
    const rod::Discretisation& wire = simulation.discretisation();
    return wire.position[node] - (wire.length() - simulation.state().inserted_length);
  }

  int inserted() const { return simulation.discretisation().nodes() - simulation::firstInsertedNode(simulation); }

  scene::Scene scene;
  vessel::Vessel vessel;
  contact::Detector detector;
  ReplayContactSource source;
  Simulation simulation;
};

double wireMass(const rod::Discretisation& wire)
{
  double sum = 0.0;
  for (const double mass : wire.mass)
    sum += mass;
  return sum;
}

TEST(AdaptiveSampling, RefinesBendsAndStaysInTheTube)
{
  Bench bench;
  const double mass = wireMass(bench.simulation.discretisation());
  for (int k = 0; k < 4000; ++k)
  {
    bench.step();
    ASSERT_TRUE(bench.simulation.report().solved) << k;
    ASSERT_LT(bench.simulation.report().max_strain, 1e-3) << k;
    ASSERT_LT(bench.simulation.surfacePenetration(), 5e-5) << k;
  }
  const rod::Discretisation& wire = bench.simulation.discretisation();
  EXPECT_NEAR(wireMass(wire), mass, 1e-12 * mass);
  const std::vector<Eigen::Vector3d>& x = bench.simulation.state().position;
  double shortest_in_bend = 1.0;
  double longest = 0.0;
  for (int i = simulation::firstInsertedNode(bench.simulation); i + 1 < wire.nodes(); ++i)
  {
    const Eigen::Vector3d before = (x[i] - x[i - 1]).normalized();
    const double turn = std::acos(std::min(1.0, before.dot((x[i + 1] - x[i]).normalized())));
    const double shorter = std::min(wire.rest_length[i - 1], wire.rest_length[i]);
    if (shorter > 0.51e-3)
    {
      EXPECT_LT(turn, 1.1 * bench.scene.sampling.turn_per_edge) << bench.beyond(i);
    }
    if (bench.beyond(i) > 0.055 && bench.beyond(i) < 0.090)
      shortest_in_bend = std::min(shortest_in_bend, wire.rest_length[i]);
    longest = std::max(longest, wire.rest_length[i]);
  }
  EXPECT_LE(shortest_in_bend, 1.01e-3);
  EXPECT_GE(longest, 1.9e-3);
  // Less than half the nodes of uniform 0.5 mm: 260.
  EXPECT_LT(bench.inserted(), 120);
}

TEST(AdaptiveSampling, KeepsTheGuidesOuterEndFineWhenPushedAndPulled)
{
  Bench bench;
  double insertion = 0.010;
  for (int k = 0; k < 4000; ++k)
  {
    insertion += k < 2500 ? 30e-6 : -30e-6;
    bench.simulation.step({insertion, 0.0});
    ASSERT_TRUE(bench.simulation.report().solved);
    if (k < 200)
      continue;
    const rod::Discretisation& wire = bench.simulation.discretisation();
    for (int j = 0; j + 1 < wire.nodes(); ++j)
    {
      const double from_guide = bench.beyond(j) + bench.scene.solver.guide_length;
      if (from_guide > -1e-3 && from_guide < 0.0)
      {
        ASSERT_LE(wire.rest_length[j], 0.26e-3) << "step " << k << " at " << from_guide;
      }
    }
  }
}

TEST(AdaptiveSampling, FollowsUniformSamplingOfHalfAMillimetreWithHalfTheNodes)
{
  Bench adaptive;
  Bench uniform({"sampling.nodes=601"});
  double largest_tip_distance = 0.0;
  for (int k = 0; k < 3000; ++k)
  {
    adaptive.step();
    uniform.step();
    const rod::State& a = adaptive.simulation.state();
    const rod::State& b = uniform.simulation.state();
    largest_tip_distance = std::max(largest_tip_distance, (a.position.back() - b.position.back()).norm());
  }
  EXPECT_LT(largest_tip_distance, 0.05e-3);
  const double energy = uniform.simulation.energy().bending;
  EXPECT_NEAR(adaptive.simulation.energy().bending, energy, 0.01 * energy);
  EXPECT_LT(2 * adaptive.inserted(), uniform.inserted());
}

/** Steps of a run, at most @p count, before which the nodes changed, with the force on the hand [N]. */
std::vector<std::pair<int, double>> changesOfNodes(const std::vector<std::string>& overrides, int steps,
                                                   std::size_t count)
{
  Bench bench(overrides);
  std::vector<double> before = bench.simulation.discretisation().position;
  std::vector<std::pair<int, double>> changes;
  for (int k = 0; k < steps; ++k)
  {
    bench.step();
    if (bench.simulation.discretisation().position != before && k > 50)
      changes.emplace_back(k, bench.simulation.state().hand_force);
    before = bench.simulation.discretisation().position;
  }
  std::vector<std::pair<int, double>> some;
  for (std::size_t c = 0; c < count; ++c)
    some.push_back(changes.at(c * changes.size() / count));
  return some;
}

TEST(AdaptiveSampling, ChangesOfTheNodesAreNotFeltAtTheHandle)
{
  // The same run with and without one change of the nodes. On long facets and a soft wall, contacts lie between nodes,
  // too.
  const std::vector<std::string> stiff = {"sampling={kind: adaptive}"};
  const std::vector<std::string> soft = {"sampling={kind: adaptive, turn_per_edge: 0.1}", "vessel.stiffness=5e6",
                                         "vessel.tube.facet_length=3e-3"};
  for (const std::vector<std::string>& overrides : {stiff, soft})
    for (const auto& [step, force] : changesOfNodes(overrides, 2500, 10))
    {
      Bench kept(overrides);
      for (int k = 0; k <= step; ++k)
      {
        if (k == step)
          kept.simulation.keepSampling();
        kept.step();
      }
      // 0.5 % of the peak of about 0.28 N.
      EXPECT_NEAR(kept.simulation.state().hand_force, force, 0.005 * 0.28) << overrides.back() << " step " << step;
    }
}

TEST(AdaptiveSampling, GivesTheSameBitsTwiceAlsoWithContactSetsMissing)
{
  const auto run = []
  {
    Bench bench;
    for (int k = 0; k < 1500; ++k)
    {
      bench.source.setFirstStalePass(k % 10 < 2 ? static_cast<std::uint32_t>(k % 2) : contact::kNoStalePass);
      bench.step();
      EXPECT_TRUE(bench.simulation.report().solved);
      EXPECT_LT(bench.simulation.surfacePenetration(), 2e-4);
    }
    return bench.simulation.trajectoryHash();
  };
  EXPECT_EQ(run(), run());
}

TEST(AdaptiveSampling, KeepsACurvedTipAndTheJointsFine)
{
  Bench bench({"instrument=instruments/guidewire_035_j.yaml", "sampling={kind: adaptive, turn_per_edge: 0.2}"});
  for (int k = 0; k < 600; ++k)
  {
    bench.step();
    ASSERT_TRUE(bench.simulation.report().solved);
  }
  const rod::Discretisation& wire = bench.simulation.discretisation();
  const std::vector<rod::Section>& sections = bench.scene.instruments.front().instrument.wire.sections;
  double joint = 0.0;
  for (std::size_t k = 0; k + 1 < sections.size(); ++k)
  {
    joint += sections[k].length;
    const auto after = std::upper_bound(wire.position.begin(), wire.position.end(), joint);
    EXPECT_LE(wire.rest_length[after - wire.position.begin() - 1], 0.51e-3) << joint;
  }
  for (int i = wire.first_curved; i + 1 < wire.nodes(); ++i)
    EXPECT_LE(wire.rest_curvature[i].norm(), 0.21);
}

TEST(AdaptiveSampling, SamplesABenchWireToo)
{
  const scene::Scene scene = scene::loadScene(std::string(PROJECT_DIR) + "/config/scenes/cantilever.yaml",
                                              {"sampling={kind: adaptive, min_edge: 1.0e-3, max_edge: 8.0e-3}"});
  Simulation simulation(scene, scene::resolveEntry(scene.entry, scene.file), nullptr);
  const double clamped_edge = simulation.discretisation().rest_length.front();
  for (int k = 0; k < 2000; ++k)
  {
    simulation.step({0.0, 0.0});
    ASSERT_TRUE(simulation.report().solved);
    ASSERT_EQ(simulation.discretisation().rest_length.front(), clamped_edge);
  }
}

TEST(AdaptiveSampling, ServesThePaperScheme)
{
  Bench bench({"sampling={kind: adaptive}", "solver.scheme=paper", "solver.time_step=0.0002", "drive.speed=0.1"});
  const int nodes = bench.simulation.discretisation().nodes();
  int changes = 0;
  for (int k = 0; k < 3000; ++k)
  {
    const int before = bench.simulation.discretisation().nodes();
    bench.step();
    ASSERT_TRUE(bench.simulation.report().solved) << "step " << k;
    ASSERT_LT(bench.simulation.report().max_strain, 1e-4) << "step " << k;
    changes += bench.simulation.discretisation().nodes() != before;
  }
  EXPECT_GT(changes, 0) << "of " << nodes << " nodes";
  EXPECT_NEAR(wireMass(bench.simulation.discretisation()),
              wireMass(rod::discretiseUniformly(bench.scene.instruments.front().instrument.wire, 100)), 1e-15);
}

}  // namespace
}  // namespace endovascular_sim::simulation
