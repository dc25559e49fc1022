#include <algorithm>
#include <cmath>

#include "benchmark/sheet/bench_session.h"
#include "benchmark/sheet/bench_tests.h"
#include "benchmark/sheet/channel_statics.h"
#include "benchmark/sheet/specimen.h"
#include "common/text/format.h"
#include "common/units.h"

namespace endovascular_sim::benchmark
{
namespace
{

constexpr const char* kScene = "bench_torque";
constexpr double kInterval = 0.01;  // s between two samples
constexpr double kFullTurn = 2.0 * M_PI;

/** Overrides of a scene with one wire in a tube: the specimen, with the clearance that the scene's own wire has. */
std::vector<std::string> setUp(const instrument::Instrument& instrument, double from_tip, const scene::Scene& base)
{
  const double clearance = base.vessel->tube->radius - base.instruments.front().instrument.wire.sections[0].radius;
  return {"instrument=" + shaftSpecimen(instrument, "specimen", from_tip, base.longest()),
          setting("vessel.tube.radius", sectionFromTip(instrument.wire, from_tip).radius + clearance)};
}

}  // namespace

BenchTest torqueTest(const instrument::Instrument& instrument, const SpecimenChoice& choice)
{
  const double from_tip = std::isnan(choice.from_tip) ? middleOfShaft(instrument.wire) : choice.from_tip;
  const rod::Section& section = sectionFromTip(instrument.wire, from_tip);
  BenchSession session(kScene, setUp(instrument, from_tip, benchScene(kScene)));
  const scene::Scene& scene = session.scene();
  const vessel::TubeShape& tube = *scene.vessel->tube;
  const double friction = std::isnan(section.friction) ? scene.vessel->friction : section.friction;
  const double last_turn = scene.instruments.front().drive.rotation.points.back().value - kFullTurn;

  std::vector<double> lags;
  std::vector<double> torques;
  std::vector<double> normal_forces;
  results::SvgPlot turns;
  turns.title = "Turn of the distal end";
  turns.abscissa = "turn of the proximal end [°]";
  turns.ordinate = "lag of the distal end [°]";
  turns.lines = {{"simulation", results::colour(0), {}}, {"statics, sliding all around", results::colour(1), {}}};
  while (!session.isOver())
  {
    session.runTo(session.time() + kInterval);
    const simulation::HandState hand = session.observe().hand(0);
    const double lag = hand.rotation - session.observe().tip(0).rotation;
    if (hand.rotation > 0.0)
      turns.lines[0].points.emplace_back(hand.rotation / units::kDegree, lag / units::kDegree);
    if (hand.rotation <= last_turn)
      continue;
    lags.push_back(lag);
    torques.push_back(hand.torque);
    double sum = 0.0;
    for (const Eigen::Vector3d& force : session.simulation().state().wall_force)
      sum += force.norm();
    normal_forces.push_back(sum);
  }

  ChannelProblem problem;
  problem.pieces = tube.pieces;
  problem.clearance = meanRadius(tube) - section.radius;
  problem.bending_stiffness = section.bending_stiffness;
  problem.inserted_length = session.observe().hand(0).insertion;
  problem.advance = 0.0;
  const ChannelState statics = channelStatics(problem);
  const ChannelTorque expected = channelTorque(statics, friction, section.radius, section.torsional_stiffness);
  for (const double at : {0.0, turns.lines[0].points.back().first})
    turns.lines[1].points.emplace_back(at, expected.lag / units::kDegree);

  BenchTest test;
  test.name = kScene;
  test.heading = "Torque response";
  test.conditions = formatted(
      "Straight specimen of the section %.0f mm from the tip, GJ %.4g N·mm², in a channel with a bend of %.0f° and "
      "%.0f mm; "
      "clearance %.3g mm, friction %.3g. Means over the last of two turns.",
      1e3 * from_tip, 1e6 * section.torsional_stiffness, totalTurn(tube) / units::kDegree,
      1e3 / sharpestCurvature(tube), 1e3 * problem.clearance, friction);
  const auto [least, most] = std::minmax_element(lags.begin(), lags.end());
  test.rows = {{"lag of the distal end", meanOf(lags) / units::kDegree, "°", expected.lag / units::kDegree,
                "brute force: statics of the wire in the channel, twist by circumferential friction"},
               {"whip: variation of the lag over a turn", (*most - *least) / units::kDegree, "°", 0.0,
                "a straight wire of equal stiffness in all planes turns evenly", true},
               {"torque at the proximal end", 1e3 * meanOf(torques), "N·mm", 1e3 * expected.torque,
                "brute force: μ r ΣN of the same statics"},
               {"sum of the normal forces ΣN", meanOf(normal_forces), "N",
                statics.totalNormalForce() / std::sqrt(1.0 + friction * friction), "brute force: the same statics"}};
  test.plots = {turns};
  return test;
}

}  // namespace endovascular_sim::benchmark
