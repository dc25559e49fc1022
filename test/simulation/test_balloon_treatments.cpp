#include "scene/scene_file.h"
#include "simulation/balloon_treatments.h"

#include <sstream>

#include <gtest/gtest.h>

#include "common/error.h"
#include "contact/detector.h"
#include "simulation/local_deformable_wall.h"
#include "simulation/simulation.h"

namespace endovascular_sim::simulation
{
namespace
{

/** A scene with its vessel, whose wall balloons move. */
struct Bench
{
  explicit Bench(const std::vector<std::string>& overrides = {},
                 const std::string& file = TEST_DATA_DIR "/scenes/good_inflation.yaml")
    : scene(scene::loadScene(file, overrides)),
      vessel(scene::buildVessel(*scene.vessel, scene.entry, scene.file)),
      detector(vessel.mesh, scene::wallLaw(*scene.vessel)),
      wall(vessel, detector),
      simulation(scene, scene::resolveEntry(scene.entry, vessel, scene.file), &detector, &vessel.centreline, &wall)
  {
  }

  void runTo(double time)
  {
    while (simulation.time() < time - 0.5 * scene.solver.time_step)
    {
      simulation.stepAll(commandsAt(scene, simulation.time() + scene.solver.time_step));
      refused += !simulation.report().solved;
      deepest = std::max(deepest, simulation.surfacePenetration());
    }
  }

  double narrowest() const
  {
    double radius = 1.0;
    for (const Eigen::Vector3d& v : detector.wall().vertices)
      if (v.z() > 0.01 && v.z() < 0.07)
        radius = std::min(radius, v.head<2>().norm());
    return radius;
  }

  bool happened(TreatmentEvent event) const
  {
    for (const TimedEvent& timed : simulation.events())
      if (timed.event == event)
        return true;
    return false;
  }

  scene::Scene scene;
  vessel::Vessel vessel;
  contact::Detector detector;
  LocalDeformableWall wall;
  Simulation simulation;
  int refused = 0;
  double deepest = 0.0;
};

TEST(BalloonTreatments, ABalloonThatFillsItsLesionIsSolvedForWithinTheSolvesOfAStep)
{
  Bench bench;
  bench.runTo(0.3);
  int solves = 0;
  int factorisations = 0;
  int hit_iteration_limit = 0;
  while (bench.simulation.time() < 0.6)
  {
    bench.runTo(bench.simulation.time() + 1e-3);
    solves += bench.simulation.report().solves;
    factorisations += bench.simulation.report().factorisations;
    hit_iteration_limit += bench.simulation.report().hit_iteration_limit;
  }
  EXPECT_GT(solves, 300);  // it presses
  EXPECT_LT(factorisations, 800);
  EXPECT_LT(hit_iteration_limit, 3);
  EXPECT_EQ(bench.refused, 0);
}

TEST(BalloonTreatments, InASimulationOpenTheLesionAndLeaveTheStentInIt)
{
  Bench bench;
  EXPECT_NEAR(bench.narrowest(), 0.8e-3, 0.05e-3);
  bench.runTo(2.0);
  EXPECT_GT(bench.narrowest(), 1.4e-3);
  EXPECT_FALSE(bench.happened(TreatmentEvent::kStentPlaced));
  bench.runTo(6.0);
  EXPECT_EQ(bench.refused, 0);
  EXPECT_LT(bench.deepest, 0.1e-3);
  EXPECT_TRUE(bench.happened(TreatmentEvent::kStentPlaced));
  EXPECT_FALSE(bench.happened(TreatmentEvent::kBurst));
  EXPECT_FALSE(bench.happened(TreatmentEvent::kStentLost));
  EXPECT_NEAR(bench.narrowest(), 1.45e-3, 0.1e-3) << "held open";
  EXPECT_NEAR(bench.simulation.hand(0).insertion, 0.015, 1e-6) << "the catheter has left the stent";
  const intervention::StentPlacement& stent = *bench.simulation.treatment(0)->stent();
  EXPECT_EQ(stent.state(), intervention::StentPlacement::State::kPlaced);
  EXPECT_NEAR(stent.sleeve().axis[stent.sleeve().axis.size() / 2].z(), 0.030, 0.5e-3);
}

std::vector<std::string> statesAt(Bench& bench, const std::vector<double>& moments)
{
  std::vector<std::string> states;
  for (const double moment : moments)
  {
    bench.runTo(moment);
    std::ostringstream stream;
    bench.simulation.save(stream, 7);
    states.push_back(stream.str());
  }
  return states;
}

TEST(BalloonTreatments, AreTheSameFromASavedStateOfAnyPhaseBitForBit)
{
  Bench whole;
  const std::vector<std::string> states = statesAt(whole, {0.05, 0.4, 1.0, 2.3, 3.6});
  whole.runTo(3.8);
  for (const std::string& state : states)
  {
    Bench resumed;
    std::istringstream stream(state);
    resumed.simulation.load(stream, 7);
    const double begin = resumed.simulation.time();
    resumed.runTo(3.8);
    EXPECT_EQ(resumed.simulation.trajectoryHash(), whole.simulation.trajectoryHash()) << "from " << begin << " s";
    EXPECT_EQ(resumed.simulation.events().size(), whole.simulation.events().size());
  }
}

TEST(BalloonTreatments, OverAWireAreTheSameFromASavedStateBitForBit)
{
  // Two instruments, adaptive: while the system passes the wire's nodes, and while its balloon opens the lesion.
  const std::string scene = PROJECT_DIR "/config/scenes/stent.yaml";
  Bench whole({}, scene);
  const std::vector<std::string> states = statesAt(whole, {4.0, 6.0});
  whole.runTo(6.2);
  for (const std::string& state : states)
  {
    Bench resumed({}, scene);
    std::istringstream stream(state);
    resumed.simulation.load(stream, 7);
    const double begin = resumed.simulation.time();
    resumed.runTo(6.2);
    EXPECT_EQ(resumed.simulation.trajectoryHash(), whole.simulation.trajectoryHash()) << "from " << begin << " s";
  }
}

std::string refusalOf(Bench& bench, const std::string& state, std::uint64_t vessel_hash = 0)
{
  try
  {
    std::istringstream stream(state);
    bench.simulation.load(stream, vessel_hash, "a.state");
  }
  catch (const InputError& error)
  {
    return error.what();
  }
  return "";
}

TEST(BalloonTreatments, StatesThatAreDamagedOrOfAnotherSceneAreRefused)
{
  Bench bench;
  bench.runTo(0.02);
  std::ostringstream stream;
  bench.simulation.save(stream);
  const std::string state = stream.str();
  Bench fresh;
  EXPECT_NE(refusalOf(fresh, "").find("a.state: is not a saved state"), std::string::npos);
  EXPECT_NE(refusalOf(fresh, state.substr(0, state.size() / 2)).find("damaged or cut off"), std::string::npos);
  for (const std::size_t place : {std::size_t{9}, state.size() / 3, state.size() - 1})
  {
    std::string garbled = state;
    garbled[place] = static_cast<char>(garbled[place] ^ 1);
    EXPECT_NE(refusalOf(fresh, garbled).find("damaged or cut off"), std::string::npos) << "byte " << place;
  }
  EXPECT_NE(refusalOf(fresh, state, 5).find("another vessel"), std::string::npos);
  Bench other({"vessel.friction=0.2"});
  EXPECT_NE(refusalOf(other, state).find("another scene"), std::string::npos);
  EXPECT_EQ(refusalOf(fresh, state), "");
  EXPECT_EQ(fresh.simulation.steps(), 20U);
}

TEST(BalloonTreatments, TellThatABalloonBurstsAndThatAStentIsLostOutside)
{
  Bench burst({"drive.pressure.points=[[0, 0], [0.2, 3.0e6]]"});
  burst.runTo(1.5);
  EXPECT_TRUE(burst.happened(TreatmentEvent::kAboveRated));
  EXPECT_TRUE(burst.happened(TreatmentEvent::kBurst));
  EXPECT_EQ(burst.simulation.treatment(0)->inflation().pressure(), 0.0);
  Bench outside({"drive.initial_insertion=0.001", "drive.insertion.points=[[0, 0]]"});
  outside.runTo(1.0);
  EXPECT_TRUE(outside.happened(TreatmentEvent::kStentLost));
  EXPECT_EQ(outside.wall.version(), 1U) << "nothing presses the wall from outside";
}

}  // namespace
}  // namespace endovascular_sim::simulation
