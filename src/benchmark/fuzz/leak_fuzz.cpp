#include "benchmark/fuzz/leak_fuzz.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <sstream>
#include <stdexcept>

#include "benchmark/fuzz/fuzz_motion.h"
#include "benchmark/harness/table.h"
#include "results/run_result.h"
#include "rod/kkt/kkt_stepper.h"
#include "scene/scene_file.h"
#include "session/session.h"
#include "simulation/instrument_tip.h"
#include "vessel/centreline/centreline.h"

namespace endovascular_sim::benchmark
{
namespace
{

constexpr double kInitialInsertion = 4e-3;   // inserted length at the start [m]
constexpr double kFastestHand = 0.5;         // largest speed of the hand [m/s]
constexpr double kFastestBesideHeart = 0.1;  // the same in a moving vessel [m/s]
constexpr double kFastestTurn = 59.0;        // largest angular speed of the hand [rad/s]
constexpr double kLargestTipMoment =
    0.02;  // largest moment that straightens a pre-curved tip [N·m]; the stiff J of peer_wire requires 0.0165
constexpr double kSuspicious = 50e-6;    // depth in the solver that triggers a check [m]
constexpr int kCheckInterval = 10;       // steps between checks
constexpr int kMovedInterval = 20;       // checks between those of the whole wire in the moved mesh
constexpr int kBruteForceInterval = 10;  // checks between brute-force searches for one node
constexpr double kDisagreement = 1e-9;   // largest difference of both searches [m]

/** Random choices that define the scene of an episode. */
struct Setup
{
  double length, radius, tip_length, tip_radius, bending, tip_bending;  // tip_radius 0: straight
  double time_step;
  double stiffness;  // stiffness of the wall; infinite: rigid
  double friction, force_limit;
  std::string sampling;
  double tip_width;  // ratio of the radius of the tip to that of the shaft
  double clearance, thickness, stiffness_ratio, layer_friction, outer_limit;  // of a catheter over the wire
  bool coaxial;
};

/** Largest radius of a wire in the vessel [m]. In trees it also encounters narrower branches. */
double largestRadius(const FuzzVessel& vessel)
{
  if (vessel.name == "channel")
    return 0.4 * vessel.narrowest;
  double widest_end = 0.0;
  for (const vessel::CentrelineEnd& end : vessel::centrelineEnds(vessel.vessel->centreline))
    widest_end = std::max(widest_end, end.radius);
  return 0.5 * widest_end;
}

/** Chooses a catheter that has room in the vessel around the wire. */
void addCatheter(const FuzzVessel& vessel, FuzzRandom& random, Setup& setup)
{
  setup.radius = std::min({setup.radius, 0.45e-3, 0.4 * largestRadius(vessel)});
  const double room = largestRadius(vessel) - setup.radius;
  setup.clearance = std::min(random.logBetween(0.03e-3, 0.5e-3), 0.5 * room);
  setup.thickness = std::min(random.between(0.1e-3, 0.4e-3), 0.5 * room);
  setup.stiffness_ratio = random.logBetween(0.2, 10.0);
  setup.layer_friction = random.chance(0.2) ? 0.0 : random.between(0.0, 0.4);
  setup.outer_limit = random.logBetween(1.0, 100.0);
  setup.force_limit = random.logBetween(1.0, 100.0);
}

Setup randomSetup(const FuzzVessel& vessel, FuzzRandom& random, bool coaxial)
{
  Setup setup;
  setup.length = random.between(0.1, 0.3);
  setup.radius = random.between(0.17e-3, 0.45e-3);
  setup.tip_length = random.between(4e-3, 20e-3);
  setup.tip_radius = random.chance(0.3) ? 0.0 : std::max(random.logBetween(3e-3, 20e-3), setup.tip_length / 4.0);
  setup.bending = random.logBetween(1.6e-6, 5e-3);
  setup.tip_bending = std::max(1.6e-6, setup.bending / random.logBetween(1.0, 100.0));
  if (setup.tip_radius > 0.0)
    setup.tip_bending = std::min(setup.tip_bending, kLargestTipMoment * setup.tip_radius);
  setup.time_step = random.logBetween(1e-4, 1e-2);
  setup.stiffness = random.chance(0.25) ? random.logBetween(5e5, 5e6) : std::numeric_limits<double>::infinity();
  setup.friction = random.chance(0.3) ? 0.0 : random.between(0.0, 0.3);
  setup.force_limit = random.logBetween(1.0, 5.0);
  // At least two edges per radius of the tightest bend; coarser wires cannot follow it.
  const double longest = std::min(2.5e-3, 0.5 * vessel.tightest);
  std::ostringstream sampling;
  if (random.chance(0.5))
    sampling << "{kind: uniform, nodes: "
             << static_cast<int>(setup.length / random.between(std::min(0.6e-3, longest), longest)) + 1 << "}";
  else
    sampling << "{kind: adaptive, min_edge: " << random.between(0.3e-3, 0.6e-3)
             << ", max_edge: " << random.between(0.4, 1.0) * longest + 0.6e-3
             << ", turn_per_edge: " << random.between(0.03, 0.1) << "}";
  setup.sampling = sampling.str();
  if (random.chance(0.2))
    setup.radius = random.between(0.6e-3, 1.33e-3);  // catheters, to 8F
  setup.radius = std::min(setup.radius, largestRadius(vessel));
  setup.tip_width = random.chance(0.3) ? random.between(0.3, 1.0) : 1.0;
  setup.coaxial = coaxial;
  if (coaxial)
    addCatheter(vessel, random, setup);
  return setup;
}

std::string wireText(const Setup& setup)
{
  std::ostringstream out;
  out.precision(12);
  out << "{name: wire, sections: [{length: " << setup.length - setup.tip_length << ", radius: " << setup.radius
      << ", material: nitinol, density: 6450, bending_stiffness: " << setup.bending
      << ", poisson_ratio: 0.3}, {length: " << setup.tip_length << ", radius: " << setup.tip_width * setup.radius
      << ", material: nitinol, density: 6450, bending_stiffness: " << setup.tip_bending << ", poisson_ratio: 0.3";
  if (setup.tip_radius > 0.0)
    out << ", rest_curvature: {radius: " << setup.tip_radius << ", direction: 0}";
  out << "}]}";
  return out.str();
}

std::string catheterText(const Setup& setup)
{
  std::ostringstream out;
  out.precision(12);
  const double bore = setup.radius + setup.clearance;
  out << "{name: catheter, kind: catheter, inner_radius: " << bore << ", sections: [{length: " << setup.length
      << ", radius: " << bore + setup.thickness << ", material: polymer, density: 1200, bending_stiffness: "
      << std::max(1.6e-6, setup.stiffness_ratio * setup.bending) << ", poisson_ratio: 0.3}]}";
  return out.str();
}

std::string driveText(double force_limit)
{
  std::ostringstream out;
  out.precision(12);
  out << "{source: script, initial_insertion: " << kInitialInsertion
      << ", insertion: {points: [[0, 0]]}, rotation: {points: [[0, 0]]}, force_limit: " << force_limit << "}";
  return out.str();
}

std::string sceneText(const Setup& setup)
{
  std::ostringstream out;
  out.precision(12);
  out << "name: fuzz\nduration: 1.0e6\nvessel: none\n";
  if (setup.coaxial)
    out << "instruments:\n  - {instrument: " << wireText(setup) << ", friction: " << setup.layer_friction
        << ", fit_load: 0, drive: " << driveText(setup.force_limit) << "}\n  - {instrument: " << catheterText(setup)
        << ", drive: " << driveText(setup.outer_limit) << "}\n";
  else
    out << "instrument: " << wireText(setup) << "\ndrive: " << driveText(setup.force_limit) << "\n";
  out << "sampling: " << setup.sampling << "\nsolver: {time_step: " << setup.time_step << "}\n";
  return out.str();
}

std::string describe(const Setup& setup, const FuzzVessel& vessel)
{
  return (vessel.detail.empty() ? "" : vessel.detail + "; ") + "EI " + number(1e6 * setup.bending) + " and " +
         number(1e6 * setup.tip_bending) + " N·mm², radius " + number(1e3 * setup.radius) + " and " +
         number(1e3 * setup.tip_width * setup.radius) + " mm, tip " +
         (setup.tip_radius > 0.0 ? "of " + number(1e3 * setup.tip_radius) + " mm" : std::string("straight")) + ", " +
         setup.sampling + ", Δt " + number(1e3 * setup.time_step) + " ms, wall " +
         (std::isfinite(setup.stiffness) ? number(1e-6 * setup.stiffness) + " N/mm per mm" : std::string("rigid")) +
         ", μ " + number(setup.friction) + ", slips at " + number(setup.force_limit) + " N" +
         (setup.coaxial ? "; catheter with " + number(1e3 * setup.clearance) + " mm clearance, EI ratio " +
                              number(setup.stiffness_ratio) + ", μ " + number(setup.layer_friction) + ", slips at " +
                              number(setup.outer_limit) + " N"
                        : std::string());
}

/** Hand with abrupt random pushes, pulls and turns. */
class RandomHand
{
public:
  /** @param fastest [m/s]  @param most largest insertion [m] */
  RandomHand(FuzzRandom& random, double time_step, double fastest, double most)
    : random_(random), time_step_(time_step), fastest_(fastest), most_(most)
  {
  }

  drive::HandCommand next()
  {
    if (left_-- <= 0)
      choose();
    insertion_ = std::clamp(insertion_ + time_step_ * speed_, 0.0, most_);
    rotation_ += time_step_ * turn_;
    return {insertion_, rotation_};
  }

private:
  void choose()
  {
    left_ = random_.integer(2, 80);
    const bool reverse = random_.chance(0.25);
    speed_ = reverse ? -speed_ : fastest_ * std::pow(random_.unit(), 2.0) * (random_.chance(0.7) ? 1.0 : -1.0);
    turn_ = random_.chance(0.4) ? 0.0 : kFastestTurn * std::pow(random_.between(-1.0, 1.0), 3.0);
  }

  FuzzRandom& random_;
  double time_step_;
  double fastest_;
  double most_;
  int left_ = 0;
  double insertion_ = kInitialInsertion;
  double rotation_ = 0.0;
  double speed_ = 0.0;
  double turn_ = 0.0;
};

/** Session of an episode in a vessel of the fuzz. */
session::Session sessionOf(const FuzzVessel& vessel, const Setup& setup, const FuzzSettings& settings,
                           const scene::EntryPose& entry)
{
  scene::Scene scene = scene::parseScene(sceneText(setup), "fuzz", settings.overrides);
  scene.vessel.emplace();
  scene.vessel->wall = settings.smooth ? contact::WallShape::kSmooth : contact::WallShape::kFacets;
  scene.vessel->stiffness = setup.stiffness;
  scene.vessel->friction = setup.friction;
  return session::Session(session::World::make(std::move(scene), vessel.vessel, vessel.wall, entry));
}

/** Nodes from the introducer to the tip. Up to its travel, the depth of a soft wall counts as compliance. */
void insertedWire(const simulation::Simulation& simulation, double stiffness, std::vector<CheckedNode>& nodes)
{
  const rod::State& state = simulation.state();
  const rod::Discretisation& wire = simulation.discretisation();
  const int first = simulation::firstInsertedNode(simulation);
  const auto add = [&](const Eigen::Vector3d& position, double radius) {
    nodes.push_back({position, radius, std::isfinite(stiffness) ? rod::softWallTravel(radius) : 0.0});
  };
  nodes.clear();
  if (first > state.first_node && first < wire.nodes())
  {
    // The mouth of the introducer, within an edge.
    const double t = (wire.length() - state.inserted_length - wire.position[first - 1]) / wire.rest_length[first - 1];
    add((1.0 - t) * state.position[first - 1] + t * state.position[first], wire.radius[first]);
  }
  for (int i = first; i < wire.nodes(); ++i)
    add(state.position[i], wire.radius[i]);
}

/** Checks the whole wire, and periodically one node by brute force. */
void checkWire(const simulation::Simulation& simulation, double stiffness, WireCheck& check, FuzzEpisode& episode,
               std::vector<CheckedNode>& nodes)
{
  insertedWire(simulation, stiffness, nodes);
  const WireFinding finding = check.check(nodes);
  ++episode.checks;
  episode.finite = finding.finite && std::isfinite(simulation.state().hand_force);
  episode.escaped = finding.outside;
  if (!finding.finite || nodes.empty())
    return;
  if (finding.depth > episode.depth)
  {
    episode.depth = finding.depth;
    episode.depth_step = episode.steps;
    episode.depth_place = 0.0;
    for (int i = 0; i < finding.edge; ++i)
      episode.depth_place += (nodes[i + 1].position - nodes[i].position).norm();
    if (finding.edge + 1 < static_cast<int>(nodes.size()))
      episode.depth_place +=
          finding.parameter * (nodes[finding.edge + 1].position - nodes[finding.edge].position).norm();
  }
  if (episode.checks % kBruteForceInterval != 1)
    return;
  const Eigen::Vector3d& one = nodes[static_cast<std::size_t>(episode.checks) * 7 % nodes.size()].position;
  if (std::abs(check.signedDistance(one) - check.bruteSignedDistance(one)) > kDisagreement)
    throw std::logic_error("WireCheck: the box tree and the brute-force search give different distances");
}

/** Checks the wire in a vessel that moves. */
void checkMovingWire(const simulation::Simulation& simulation, double stiffness, WireCheck& at_rest,
                     MovedVesselCheck& moved, FuzzEpisode& episode, std::vector<CheckedNode>& nodes)
{
  const motion::MotionMap& map = simulation.motion()->patient().map();
  insertedWire(simulation, stiffness, nodes);
  ++episode.checks;
  std::vector<CheckedNode> axis;
  for (const CheckedNode& node : nodes)
    axis.push_back({map.pullBack(node.position), 0.0, 0.0});
  const WireFinding inside = at_rest.check(axis);
  episode.finite = inside.finite && std::isfinite(simulation.state().hand_force);
  episode.escaped = inside.outside;
  if (!inside.finite || nodes.empty())
    return;
  if (episode.checks % kBruteForceInterval == 1)
  {
    const Eigen::Vector3d& one = nodes[static_cast<std::size_t>(episode.checks) * 7 % nodes.size()].position;
    episode.escaped = episode.escaped || moved.bruteSignedDistance(map, one) < 0.0;
  }
  if (episode.checks % kMovedInterval != 1 && simulation.surfacePenetration() < 2.0 * kSuspicious)
    return;
  const WireFinding finding = moved.check(map, nodes);
  episode.escaped = episode.escaped || finding.outside;
  if (finding.depth > episode.depth)
  {
    episode.depth = finding.depth;
    episode.depth_step = episode.steps;
  }
}

}  // namespace

FuzzEpisode fuzzEpisode(FuzzVessels& vessels, const FuzzSettings& settings, std::uint64_t number)
{
  FuzzRandom random(settings.seed, number);
  FuzzVessel& vessel = vessels.get(vessels.kinds()[number % vessels.kinds().size()], random);
  const Setup setup = randomSetup(vessel, random, settings.coaxial);
  const double widest = setup.radius + (setup.coaxial ? setup.clearance + setup.thickness : 0.0);
  const scene::EntryPose entry = randomEntry(vessel, random, widest, 1.5 * kInitialInsertion);
  session::Session session = sessionOf(vessel, setup, settings, entry);
  const simulation::Simulation& simulation = session.simulation();
  std::optional<MovedVesselCheck> moved;
  if (settings.moving)
  {
    const simulation::PatientMotion motion = randomMotion(vessel, entry, setup.time_step, random);
    session.simulation().setMotion(motion);
    moved.emplace(settings.smooth ? vessel.checked : vessel.vessel->mesh, motion.bounds);
  }

  FuzzEpisode episode;
  episode.number = number;
  episode.vessel = vessel.name;
  episode.description = describe(setup, vessel);
  std::vector<CheckedNode> nodes;
  std::vector<RandomHand> hands(
      setup.coaxial ? 2 : 1,
      RandomHand(random, setup.time_step, settings.moving ? kFastestBesideHeart : kFastestHand, setup.length));
  const double grips = setup.force_limit + (setup.coaxial ? setup.outer_limit : 0.0);
  while (episode.steps < settings.steps_per_episode && episode.finite && !episode.escaped)
  {
    std::vector<drive::HandCommand> commands;
    for (RandomHand& hand : hands)
      commands.push_back(hand.next());
    session.step(commands);
    ++episode.steps;
    const rod::StepReport& report = simulation.report();
    episode.rejected += !report.solved;
    episode.hit_iteration_limit += report.hit_iteration_limit;
    episode.max_strain = std::max(episode.max_strain, report.max_strain);
    for (int k = 0; k < simulation.instruments(); ++k)
      episode.force = std::max(episode.force, std::abs(simulation.hand(k).force));
    episode.over_grips = episode.force / grips;
    const bool suspicious = !moved && (simulation.surfacePenetration() > kSuspicious || !report.solved);
    if (moved && episode.steps % kCheckInterval == 0)
      checkMovingWire(simulation, setup.stiffness, *vessel.check, *moved, episode, nodes);
    else if (suspicious || episode.steps % kCheckInterval == 0)
      checkWire(simulation, setup.stiffness, *vessel.check, episode, nodes);
  }
  if (episode.escaped || !episode.finite)
    episode.bad_step = episode.steps;
  return episode;
}

}  // namespace endovascular_sim::benchmark
