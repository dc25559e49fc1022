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

constexpr const char* kScene = "bench_pushability";
constexpr double kInterval = 0.005;  // s between two samples
constexpr double kAtTip = 1.5e-3;    // m, length of wire whose contacts with the end are counted
/** Distal forces between which the slope is taken, over EI/R². The wire is then pressed onto the outside of the bends,
 *  as a rope. */
constexpr double kLowForce = 5.0;
constexpr double kHighForce = 10.0;

/** Forces of a sample. */
struct Pushed
{
  double proximal = 0.0;  ///< [N]
  double distal = 0.0;    ///< [N]
};

/** Force of the closed end on the tip: that along the wire, on its last nodes. */
Pushed read(BenchSession& session)
{
  const rod::State& state = session.simulation().state();
  const std::vector<double>& along = session.simulation().discretisation().position;
  const Eigen::Vector3d direction = (state.position.back() - state.position[state.position.size() - 2]).normalized();
  Pushed pushed;
  pushed.proximal = session.observe().hand(0).force;
  for (std::size_t i = state.position.size(); i-- > 0 && along[i] > along.back() - kAtTip;)
    pushed.distal -= direction.dot(state.wall_force[i]);
  return pushed;
}

/** Least-squares line through samples. @return intercept and slope of the proximal over the distal force */
std::pair<double, double> lineThrough(const std::vector<Pushed>& samples)
{
  Pushed mean;
  for (const Pushed& sample : samples)
  {
    mean.proximal += sample.proximal / static_cast<double>(samples.size());
    mean.distal += sample.distal / static_cast<double>(samples.size());
  }
  double product = 0.0;
  double square = 0.0;
  for (const Pushed& sample : samples)
  {
    product += (sample.distal - mean.distal) * (sample.proximal - mean.proximal);
    square += (sample.distal - mean.distal) * (sample.distal - mean.distal);
  }
  const double slope = square > 0.0 ? product / square : 0.0;
  return {mean.proximal - slope * mean.distal, slope};
}

}  // namespace

BenchTest pushabilityTest(const instrument::Instrument& instrument, const SpecimenChoice& choice)
{
  const double from_tip = std::isnan(choice.from_tip) ? middleOfShaft(instrument.wire) : choice.from_tip;
  const rod::Section& section = sectionFromTip(instrument.wire, from_tip);
  const scene::Scene base = benchScene(kScene);
  const double own_clearance = base.vessel->tube->radius - base.instruments.front().instrument.wire.sections[0].radius;
  BenchSession session(kScene, {"instrument=" + shaftSpecimen(instrument, "specimen", from_tip, base.longest()),
                                setting("vessel.tube.radius", section.radius + own_clearance)});
  const vessel::TubeShape& tube = *session.scene().vessel->tube;
  const double curvature = sharpestCurvature(tube);
  const double turn = totalTurn(tube);
  const double unit = section.bending_stiffness * curvature * curvature;
  const double friction = std::isnan(section.friction) ? session.scene().vessel->friction : section.friction;

  std::vector<Pushed> samples;
  results::SvgPlot plot;
  plot.title = "Proximal over distal force";
  plot.abscissa = "distal force [N]";
  plot.ordinate = "proximal force [N]";
  plot.lines = {{"simulation", results::colour(0), {}}, {"statics", results::colour(1), {}}};
  Pushed now;
  while (!session.isOver() && now.distal < 1.05 * kHighForce * unit)
  {
    session.runTo(session.time() + kInterval);
    now = read(session);
    if (now.distal > 0.05 * unit)
      plot.lines[0].points.emplace_back(now.distal, now.proximal);
    if (now.distal > kLowForce * unit && now.distal < kHighForce * unit)
      samples.push_back(now);
  }
  const auto [intercept, slope] = lineThrough(samples);

  ChannelProblem problem;
  problem.pieces = tube.pieces;
  problem.clearance = meanRadius(tube) - section.radius;
  problem.bending_stiffness = section.bending_stiffness;
  problem.friction = friction;
  problem.inserted_length = 0.0;
  for (const vessel::TubePiece& piece : tube.pieces)
    problem.inserted_length += piece.length;
  std::vector<double> expected;
  for (const double force : {kLowForce * unit, kHighForce * unit})
  {
    problem.tip_force = force;
    expected.push_back(channelStatics(problem).hand_force);
    plot.lines[1].points.emplace_back(force, expected.back());
  }

  BenchTest test;
  test.name = kScene;
  test.heading = "Pushability";
  test.conditions = formatted(
      "Straight specimen of the section %.0f mm from the tip, EI %.4g N·mm², in a channel with bends of %.0f° in "
      "sum and %.0f mm; clearance %.3g mm, friction %.3g; distal forces of 5 to 10 EI/R².",
      1e3 * from_tip, 1e6 * section.bending_stiffness, turn / units::kDegree, 1e3 / curvature, 1e3 * problem.clearance,
      friction);
  const double high = kHighForce * unit;
  test.rows = {{formatted("proximal force for a distal force of %.3g N", high), intercept + slope * high, "N",
                expected[1], "brute force: statics of the wire in the channel with friction"},
               {"transmitted share of a further push", 100.0 / slope, "%",
                100.0 * high * 0.5 / (expected[1] - expected[0]), "brute force: the same statics"}};
  test.plots = {plot};
  return test;
}

}  // namespace endovascular_sim::benchmark
