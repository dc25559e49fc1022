#include "session/session.h"

#include <cmath>
#include <filesystem>
#include <limits>
#include <stdexcept>
#include <thread>

#include <gtest/gtest.h>

#include "common/error.h"
#include "contact/detector.h"
#include "simulation/instrument_tip.h"
#include "simulation/local_deformable_wall.h"
#include "test/common/input_error_of.h"
#include "test/common/temporary_folder.h"

namespace endovascular_sim::session
{
namespace
{

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

/** Tube with a scripted operator: the wire is pushed, then turned. */
std::shared_ptr<const World> tubeWithOperator(const std::vector<std::string>& overrides = {})
{
  return World::parse(
      "duration: 2\n"
      "vessel: {friction: 0.1, tube: {radius: 0.004, pieces: [{length: 0.05}, {length: 0.05, curvature: 20}]}}\n"
      "entry: {position: [0, 0, 0], direction: [0, 0, 1], up: [1, 0, 0]}\n"
      "instruments:\n"
      "  - {instrument: {use: guidewire_035_j, name: wire}, drive: {source: procedure, initial_insertion: 0.03}}\n"
      "procedure:\n"
      "  steps:\n"
      "    - {phase: First, advance: wire, until: {insertion: 0.06}, speed: 0.05}\n"
      "    - {phase: Second, rotate: wire, until: {turned: 1.0}}\n",
      "tube with an operator", overrides);
}

std::shared_ptr<const World> tube()
{
  static const std::shared_ptr<const World> world = World::open("tube");
  return world;
}

std::uint64_t hashAfter(Session& session, int steps)
{
  session.step(steps);
  return session.simulation().trajectoryHash();
}

TEST(Session, FindsABundledSceneByItsName)
{
  const Session by_name("tube");
  const Session by_path(PROJECT_DIR "/config/scenes/tube.yaml");
  EXPECT_EQ(by_name.scene().resolved_yaml, by_path.scene().resolved_yaml);
}

TEST(Session, EndsAfterTheDurationOfTheScene)
{
  Session session("tube", {"duration=0.01"});
  EXPECT_EQ(session.step(4), 4);
  EXPECT_FALSE(session.isOver());
  EXPECT_EQ(session.step(100), 6);
  EXPECT_TRUE(session.isOver());
  EXPECT_EQ(session.observe().step(), 10U);
}

TEST(Session, GoesOnToALaterLastStep)
{
  Session session("tube", {"duration=0.01"});
  session.setLastStep(15);
  EXPECT_EQ(session.step(100), 15);
}

TEST(Session, NeedsNoVessel)
{
  Session session("straight_wire", {"duration=0.01"});
  session.step();
  EXPECT_EQ(session.world().vessel(), nullptr);
  EXPECT_TRUE(session.wall().triangles.empty());
  EXPECT_EQ(session.observe().step(), 1U);
  EXPECT_EQ(session.observe().branch(0).branch, -1);
  EXPECT_TRUE(session.observe().forces().empty());
}

TEST(Session, SharesOneWallWithOtherSessionsOfItsWorld)
{
  const long before = tube()->wall().use_count();
  Session first(tube());
  Session second(tube());
  EXPECT_EQ(tube()->wall().use_count(), before + 2);
  EXPECT_EQ(first.detector()->model(), second.detector()->model());
  EXPECT_EQ(hashAfter(first, 50), hashAfter(second, 50));
}

TEST(World, SharesVesselAndWallWithAnotherSceneOfTheVessel)
{
  const std::shared_ptr<const World> world = tubeWithOperator();
  scene::Scene rough = world->scene();
  rough.vessel->friction = 0.5;
  const std::shared_ptr<const World> other = world->with(rough);
  EXPECT_EQ(other->wall(), world->wall());
  EXPECT_EQ(other->vessel(), world->vessel());
  EXPECT_EQ(other->meshHash(), world->meshHash());
  Session unchanged(world);
  Session shared(other);
  Session opened(tubeWithOperator({"vessel.friction=0.5"}));
  const std::uint64_t expected = hashAfter(opened, 600);
  EXPECT_EQ(hashAfter(shared, 600), expected);
  EXPECT_NE(hashAfter(unchanged, 600), expected);
}

TEST(World, RefusesASceneThatDoesNotFitTheVessel)
{
  scene::Scene scene = tube()->scene();
  scene.instruments.front().drive.initial_insertion = 10.0;
  EXPECT_THROW(tube()->with(scene), InputError);
  scene.vessel.reset();
  EXPECT_THROW(tube()->with(scene), std::invalid_argument);
  EXPECT_THROW(World::open("straight_wire")->with(tube()->scene()), std::invalid_argument);
}

TEST(Session, KeepsItsWorldAlive)
{
  Session session(World::open("tube"));
  const std::weak_ptr<const World> world = session.sharedWorld();
  session.step(5);
  EXPECT_FALSE(world.expired());
  session = Session(tube());
  EXPECT_TRUE(world.expired());
}

TEST(Session, StepsInAThreadBesideOthersWithTheSameBits)
{
  Session alone(tube());
  const std::uint64_t expected = hashAfter(alone, 100);
  std::vector<Session> sessions;
  for (int k = 0; k < 3; ++k)
    sessions.emplace_back(tube());
  std::vector<std::thread> threads;
  for (Session& session : sessions)
    threads.emplace_back([&session] { session.step(100); });
  for (std::thread& thread : threads)
    thread.join();
  for (const Session& session : sessions)
    EXPECT_EQ(session.simulation().trajectoryHash(), expected);
}

TEST(Session, IsAfterAResetAsANewOne)
{
  const std::shared_ptr<const World> world = tubeWithOperator();
  Session used(world);
  used.step(900);
  used.reset();
  Session fresh(world);
  EXPECT_EQ(used.observe().step(), 0U);
  EXPECT_EQ(used.save(), fresh.save());
  EXPECT_EQ(hashAfter(used, 900), hashAfter(fresh, 900));
  EXPECT_EQ(used.save(), fresh.save());
}

TEST(Session, VariesItsStartByTheSeedOfAReset)
{
  Session session(tubeWithOperator());
  const std::uint64_t plain = hashAfter(session, 200);
  session.reset(7);
  EXPECT_NE(session.observe().hand(0).insertion, 0.03);
  const std::uint64_t varied = hashAfter(session, 200);
  EXPECT_NE(varied, plain);
  session.reset(7);
  EXPECT_EQ(hashAfter(session, 200), varied);
  session.reset();
  EXPECT_EQ(hashAfter(session, 200), plain);
}

TEST(Session, RefusesASeedWhoseStartLiesBeyondTheWall)
{
  SessionSettings settings;
  settings.spread.insertion = 1.0;
  const std::shared_ptr<const World> world = tubeWithOperator();
  Session session(world, settings);
  session.step(10);
  int refused = 0;
  for (std::uint64_t seed = 1; seed <= 8; ++seed)
    try
    {
      session.reset(seed);
    }
    catch (const InputError&)
    {
      ++refused;
    }
  EXPECT_GT(refused, 0);
  session.reset();
  session.step(10);
}

TEST(Session, ContinuesASavedProcedureInAnotherSessionOfItsWorld)
{
  const std::shared_ptr<const World> world = tubeWithOperator();
  Session first(world);
  first.step(500);
  const std::string state = first.save();
  Session second(world);
  second.step(30);
  second.load(state);
  EXPECT_EQ(second.observe().step(), 500U);
  while (first.step(100) > 0)
    EXPECT_EQ(second.step(100) > 0, true);
  EXPECT_EQ(first.scriptedOperator()->progress(), procedure::Progress::kDone);
  EXPECT_EQ(first.simulation().trajectoryHash(), second.simulation().trajectoryHash());
  EXPECT_EQ(first.save(), second.save());
}

TEST(Session, ContinuesAStateOfAnotherSeed)
{
  const std::shared_ptr<const World> world = tubeWithOperator();
  Session first(world);
  first.reset(5);
  first.step(300);
  const std::string state = first.save();
  Session second(world);
  second.load(state);
  EXPECT_EQ(second.seed(), 5U);
  EXPECT_EQ(hashAfter(first, 500), hashAfter(second, 500));
  EXPECT_EQ(first.save(), second.save());
}

TEST(Session, OfPlainStartsOnlyRefusesAStateOfASeedWithoutAnEffect)
{
  SessionSettings settings;
  settings.varied = false;
  Session first(tubeWithOperator());
  Session second(first.sharedWorld(), settings);
  first.step(300);
  second.load(first.save());
  first.reset(5);
  first.step(100);
  const std::string message = inputErrorOf([&] { second.load(first.save(), "a.state"); });
  EXPECT_NE(message.find("a.state: has a varied start"), std::string::npos) << message;
  EXPECT_EQ(second.observe().step(), 300U);
  EXPECT_EQ(second.seed(), 0U);
}

TEST(Session, ContinuesAStateWithACommandInProgress)
{
  SessionSettings settings;
  settings.clients = true;
  const std::shared_ptr<const World> world = World::open("tube", {"drive.source=topic"});
  Session first(world, settings);
  const double start = first.observe().hand(0).insertion;
  EXPECT_EQ(
      first.control(0).command("test", drive::jointCommand(drive::CommandKind::kMovePosition, {}, {start + 0.03, 0.5})),
      drive::CommandVerdict::kAccepted);
  first.step(100);
  Session second(world, settings);
  second.load(first.save());
  EXPECT_EQ(hashAfter(first, 400), hashAfter(second, 400));
  EXPECT_GT(first.observe().hand(0).insertion, start + 0.005);
  EXPECT_EQ(first.save(), second.save());
}

TEST(Session, ContinuesAndBeginsAgainWithAWallThatABalloonDeforms)
{
  const std::shared_ptr<const World> world = World::open(TEST_DATA_DIR "/scenes/good_inflation.yaml");
  Session first(world);
  first.step(500);  // the balloon is inflated
  const std::string state = first.save();
  EXPECT_NE(first.wall().vertices, world->vessel()->mesh.vertices);
  Session second(world);
  second.load(state);
  EXPECT_EQ(second.wall().vertices, first.wall().vertices);
  EXPECT_EQ(hashAfter(first, 100), hashAfter(second, 100));
  first.reset();
  EXPECT_EQ(first.wall().vertices, world->vessel()->mesh.vertices);
  second.load(state);
  EXPECT_EQ(Session(world).save(), first.save());
}

TEST(Session, CopiesNoWallInAnInflationThatWasPrepared)
{
  const std::shared_ptr<const World> world = World::open(TEST_DATA_DIR "/scenes/good_inflation.yaml");
  Session prepared(world);
  prepared.prepareInflation();
  const contact::WallModel* const wall = prepared.detector()->model().get();
  Session other(world);
  EXPECT_NE(wall, other.detector()->model().get());
  EXPECT_EQ(hashAfter(prepared, 500), hashAfter(other, 500));
  EXPECT_NE(prepared.wall().vertices, world->vessel()->mesh.vertices);
  EXPECT_EQ(prepared.detector()->model().get(), wall);
}

TEST(World, NamesTheLibraryThatASceneWithARobotNeeds)
{
  const std::string message = inputErrorOf([&] { World::open(TEST_DATA_DIR "/robot_in_tube.yaml"); });
  EXPECT_NE(message.find("endovascular_sim::robot"), std::string::npos) << message;
}

TEST(Session, AdoptsTheShapeOfAStateUnderAnotherFriction)
{
  Session first(tubeWithOperator());
  first.step(900);
  const std::string state = first.save();
  scene::Scene rough = first.scene();
  rough.vessel->friction = 0.5;
  rough.resolved_yaml += "# rough\n";
  Session second(first.world().with(rough));
  EXPECT_THROW(second.load(state), InputError);
  const std::vector<std::string> dropped = second.adopt(state);
  ASSERT_EQ(dropped.size(), 3U);
  EXPECT_NE(dropped[1].find("operator"), std::string::npos);
  EXPECT_EQ(second.observe().nodes(), first.observe().nodes());
  EXPECT_EQ(second.observe().step(), 900U);
  EXPECT_EQ(second.observe().hand(0).insertion, first.observe().hand(0).insertion);
  const double before = second.observe().hand(0).insertion;
  const drive::HandCommand hold = {before, second.observe().hand(0).rotation, 0.0};
  second.step({hold}, 50);
  EXPECT_EQ(second.observe().hand(0).insertion, before);
  for (std::size_t k = 0; k < second.observe().nodes().size(); ++k)
    EXPECT_LT((second.observe().nodes()[k] - first.observe().nodes()[k]).norm(), 1e-3);
}

TEST(Session, AdoptsUnderEqualParametersTheSameMotion)
{
  Session first(tube());
  first.step(2500);
  Session second(tube());
  second.adopt(first.save());
  first.step(200);
  second.step(200);
  EXPECT_LT((second.observe().tip(0).position - first.observe().tip(0).position).norm(), 2e-5);
}

TEST(Session, AdoptsNothingOfOtherInstrumentsOrNodes)
{
  Session session(tube());
  session.step(20);
  const std::string state = session.save();
  for (const char* change : {"sampling.nodes=100", "instrument.use=guidewire_035_j", "vessel.tube.radius=0.004"})
  {
    Session other("tube", {change});
    other.step(10);
    const std::string before = other.save();
    const std::string message = inputErrorOf([&] { other.adopt(state); });
    EXPECT_NE(message.find("state: "), std::string::npos) << change;
    EXPECT_EQ(other.save(), before);
  }
}

TEST(Session, TakesOverNothingOfARefusedState)
{
  Session session(tube());
  session.step(20);
  const std::string state = session.save();
  std::string damaged = state;
  damaged[damaged.size() / 2] ^= 1;
  EXPECT_THROW(session.load(damaged), InputError);
  EXPECT_THROW(session.load("no state"), InputError);
  EXPECT_EQ(session.save(), state);
  Session untouched(tube());
  EXPECT_EQ(hashAfter(session, 30), hashAfter(untouched, 50));
}

TEST(Session, MovesByCommandsAsByTheDrivesOfTheScene)
{
  Session by_drives(tube());
  Session by_commands(tube());
  const double dt = by_drives.scene().solver.time_step;
  for (int step = 1; step <= 100; ++step)
    by_commands.step(simulation::commandsAt(by_commands.scene(), step * dt));
  EXPECT_EQ(by_commands.simulation().trajectoryHash(), hashAfter(by_drives, 100));
}

TEST(Session, RepeatsACommandInEveryStepOfACall)
{
  Session at_once(tube());
  Session one_by_one(tube());
  const std::vector<drive::HandCommand> commands = {{at_once.observe().hand(0).insertion + 0.01, 0.3}};
  at_once.step(commands, 50);
  for (int k = 0; k < 50; ++k)
    one_by_one.step(commands);
  EXPECT_EQ(at_once.simulation().trajectoryHash(), one_by_one.simulation().trajectoryHash());
}

TEST(Session, ObservesHandsTipsNodesContactsForcesAndBranches)
{
  Session session(tubeWithOperator());
  session.step(700);
  const Observation& seen = session.observe();
  const simulation::Simulation& simulation = session.simulation();
  EXPECT_EQ(seen.step(), 700U);
  EXPECT_DOUBLE_EQ(seen.time(), 0.7);
  EXPECT_EQ(seen.instruments(), 1);
  EXPECT_EQ(seen.hand(0).insertion, simulation.hand(0).insertion);
  EXPECT_EQ(seen.hand(0).force, simulation.hand(0).force);
  const Tip tip = seen.tip(0);
  EXPECT_LT((tip.position - simulation.state().position.back()).norm(), 1e-9);
  EXPECT_NEAR(tip.frame.determinant(), 1.0, 1e-9);
  EXPECT_EQ(tip.rotation, simulation::tipRotation(simulation, 0));
  EXPECT_EQ(&seen.nodes(), &simulation.state().position);
  EXPECT_EQ(seen.firstNode(), simulation.state().first_node);
  EXPECT_EQ(&seen.contacts(), &simulation.contactSet());
  EXPECT_FALSE(seen.forces().empty());
  EXPECT_EQ(seen.forces().size(), simulation::wallContacts(simulation).size());
  EXPECT_EQ(seen.branch(0).branch, 0);
  EXPECT_EQ(seen.branchName(0), session.world().branches()->name(0));
  EXPECT_TRUE(seen.events().empty());
}

TEST(Session, ComputesTheForcesOfEveryStepOnce)
{
  Session session(tubeWithOperator());
  session.step(400);
  const std::vector<simulation::WallContact>& forces = session.observe().forces();
  EXPECT_EQ(&forces, &session.observe().forces());
  session.step(300);
  const std::vector<simulation::WallContact> expected = simulation::wallContacts(session.simulation());
  ASSERT_FALSE(expected.empty());
  ASSERT_EQ(session.observe().forces().size(), expected.size());
  for (std::size_t k = 0; k < expected.size(); ++k)
    EXPECT_EQ(session.observe().forces()[k].normal_force, expected[k].normal_force);
}

TEST(Session, RefusesWrongCommandsWithoutAnEffect)
{
  Session session(tube());
  session.step(10);
  const std::string state = session.save();
  EXPECT_THROW(session.step(std::vector<drive::HandCommand>()), std::invalid_argument);
  EXPECT_THROW(session.step(std::vector<drive::HandCommand>(2)), std::invalid_argument);
  EXPECT_THROW(session.step({{kNaN, 0.0, 0.0}}), std::invalid_argument);
  EXPECT_THROW(session.step({{0.0, INFINITY, 0.0}}), std::invalid_argument);
  EXPECT_THROW(session.step({{0.0, 0.0, 1e5}}), std::invalid_argument);
  EXPECT_THROW(session.step(-1), std::invalid_argument);
  EXPECT_THROW(session.step({{0.0, 0.0, 0.0}}, -1), std::invalid_argument);
  EXPECT_THROW(session.control(0), std::invalid_argument);
  EXPECT_EQ(session.save(), state);
}

TEST(Session, RefusesAControlOfAnInstrumentWithoutClients)
{
  SessionSettings settings;
  settings.clients = true;
  Session session(tube(), settings);
  EXPECT_THROW(session.control(0), std::invalid_argument);
  EXPECT_THROW(session.control(-1), std::invalid_argument);
  EXPECT_THROW(session.control(1), std::invalid_argument);
}

TEST(Session, RefusesASceneThatDoesNotExistAndOpensTheNextOne)
{
  EXPECT_THROW(Session("no_such_scene"), InputError);
  EXPECT_THROW(Session("tube", {"drive.sped=1"}), InputError);
  EXPECT_THROW(World::parse("vessel: {tube: 1}"), InputError);
  EXPECT_THROW(Session(std::shared_ptr<const World>()), std::invalid_argument);
  Session session("tube");
  EXPECT_EQ(session.step(3), 3);
}

TEST(Session, RefusesEveryUseAfterItWasMovedFrom)
{
  Session session(tube());
  Session other(std::move(session));
  EXPECT_THROW(session.step(), std::logic_error);       // NOLINT(bugprone-use-after-move)
  EXPECT_THROW(session.reset(), std::logic_error);      // NOLINT(bugprone-use-after-move)
  EXPECT_THROW(session.observe(), std::logic_error);    // NOLINT(bugprone-use-after-move)
  EXPECT_THROW(session.save(), std::logic_error);       // NOLINT(bugprone-use-after-move)
  EXPECT_THROW(session.load(""), std::logic_error);     // NOLINT(bugprone-use-after-move)
  EXPECT_THROW(session.image(), std::logic_error);      // NOLINT(bugprone-use-after-move)
  EXPECT_THROW(session.finish("x"), std::logic_error);  // NOLINT(bugprone-use-after-move)
  EXPECT_EQ(other.step(), 1);
}

TEST(Session, StepsByTheCommandsOfItsOperatorAsByItself)
{
  Session by_commands(tubeWithOperator());
  Session by_itself(tubeWithOperator());
  for (int step = 0; step < 300; ++step)
  {
    const std::vector<drive::HandCommand>* commands = by_commands.scriptedCommands();
    ASSERT_NE(commands, nullptr);
    EXPECT_EQ(by_commands.scriptedCommands(), commands);  // asking again changes nothing
    by_commands.step(*commands);
  }
  EXPECT_EQ(by_itself.step(300), 300);
  EXPECT_EQ(by_commands.simulation().trajectoryHash(), by_itself.simulation().trajectoryHash());
  EXPECT_EQ(Session(tube()).scriptedCommands(), nullptr);
}

TEST(Session, SavesAndLoadsControlsThatItsCallerKeeps)
{
  Session session(tubeWithOperator());
  session.step(120);
  double kept = 3.5;
  const std::string state = session.save([&kept](Archive& archive) { archive(kept); });
  kept = 0.0;
  Session loaded(session.sharedWorld());
  loaded.load(state, "state",
              [&kept](Archive* archive, const simulation::Simulation& simulation)
              {
                EXPECT_EQ(simulation.steps(), 120U);
                ASSERT_NE(archive, nullptr);
                (*archive)(kept);
              });
  EXPECT_EQ(kept, 3.5);
  EXPECT_EQ(hashAfter(loaded, 100), hashAfter(session, 100));
  loaded.load(session.save(), "state",
              [](Archive* archive, const simulation::Simulation&) { EXPECT_EQ(archive, nullptr); });
}

TEST(Session, TakesItsContactSetsFromAGivenSource)
{
  SessionSettings settings;
  settings.contacts = std::make_shared<contact::Detector>(tube()->wall(), scene::wallLaw(*tube()->scene().vessel));
  Session injected(tube(), settings);
  EXPECT_EQ(injected.detector(), nullptr);
  Session usual(tube());
  EXPECT_EQ(hashAfter(injected, 100), hashAfter(usual, 100));
  EXPECT_THROW(Session(World::open("straight_wire"), settings), std::invalid_argument);
}

TEST(Session, TakesAnImageThatDependsOnStateAndViewOnly)
{
  Session session("tube", {"fluoroscopy={pixels: 64}"});
  session.step(50);
  const std::vector<std::uint16_t> ap = session.image().raw;
  const std::vector<std::uint16_t> oblique = session.image("LAO 40 CRA 20").raw;
  EXPECT_NE(ap, oblique);
  EXPECT_EQ(session.image().raw, ap);
  Session other(session.sharedWorld());
  other.load(session.save());
  EXPECT_EQ(other.image("LAO 40 CRA 20").raw, oblique);
  EXPECT_THROW(session.image("sideways"), InputError);
  EXPECT_EQ(session.image("").raw, ap);
}

TEST(Session, RefusesAnImageOfASceneWithoutFluoroscopy)
{
  Session session(World::open("tube", {"fluoroscopy=none"}));
  EXPECT_THROW(session.image(), InputError);
  session.step();
}

TEST(Session, WritesItsResults)
{
  const TemporaryFolder folder;
  SessionSettings settings;
  settings.results = true;
  Session session(tubeWithOperator(), settings);
  while (session.step(100) > 0)
  {
  }
  session.finish(folder.path());
  for (const char* file : {"result.json", "scene.yaml", "wall_forces.csv", "vessel_points.csv", "metrics.json",
                           "metrics.html", "instruments.csv"})
    EXPECT_GT(std::filesystem::file_size(folder.path() / file), 0U) << file;
  EXPECT_EQ(contentOf(folder.file("result.json")), session.record().resultJson());
  EXPECT_EQ(session.record().metrics()->steps().size(), 2U);
}

TEST(Session, WritesNoResultsThatItHasNotGathered)
{
  Session session(tube());
  EXPECT_THROW(session.finish(testing::TempDir()), std::logic_error);
  EXPECT_THROW(session.record(), std::logic_error);
}

TEST(Session, GathersResultsWithoutAnEffectOnTheTrajectory)
{
  SessionSettings settings;
  settings.results = true;
  Session with(tube(), settings);
  Session without(tube());
  EXPECT_EQ(hashAfter(with, 100), hashAfter(without, 100));
}

}  // namespace
}  // namespace endovascular_sim::session
