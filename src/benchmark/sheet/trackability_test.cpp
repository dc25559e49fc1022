#include <algorithm>
#include <cmath>

#include "benchmark/sheet/bench_session.h"
#include "benchmark/sheet/bench_tests.h"
#include "benchmark/sheet/channel_statics.h"
#include "benchmark/sheet/specimen.h"
#include "common/error.h"
#include "common/text/format.h"
#include "common/units.h"
#include "scene/instrument_library.h"

namespace endovascular_sim::benchmark
{
namespace
{

constexpr const char* kScene = "bench_trackability";
constexpr double kInterval = 0.01;  // s between two samples
/** Part of the bend that the tip passes during the measurement, which leaves out its ends. */
constexpr double kFrom = 0.35;
constexpr double kTo = 0.85;
constexpr int kReferences = 5;  // positions of the tip for which the reference is computed

const std::vector<std::string> kWires = {"guidewire_035_straight", "guidewire_014_workhorse"};
const std::vector<std::string> kCatheters = {"microcatheter", "catheter_5f_multipurpose", "guide_6f_jl4"};

/** Guidewire and catheter of a test. */
struct Pair
{
  instrument::Instrument wire;
  instrument::Instrument catheter;
  double wire_from_tip = 0.0;      ///< section of the specimen [m]
  double catheter_from_tip = 0.0;  ///< [m]

  const rod::Section& wireSection() const { return sectionFromTip(wire.wire, wire_from_tip); }
  const rod::Section& catheterSection() const { return sectionFromTip(catheter.wire, catheter_from_tip); }
};

/** Library's partner for an instrument.
 *  @throws InputError if none fits */
Pair pairOf(const instrument::Instrument& own, const SpecimenChoice& choice)
{
  const double from_tip = std::isnan(choice.from_tip) ? middleOfShaft(own.wire) : choice.from_tip;
  const bool is_wire = own.inner_radius <= 0.0;
  for (const std::string& name : is_wire ? kCatheters : kWires)
  {
    const instrument::Instrument other = scene::loadInstrument(scene::libraryInstrument(name));
    const double others_from_tip = middleOfShaft(other.wire);
    const Pair pair =
        is_wire ? Pair{own, other, from_tip, others_from_tip} : Pair{other, own, others_from_tip, from_tip};
    if (pair.wireSection().radius < pair.catheter.inner_radius)
      return pair;
  }
  throw InputError(own.name, "", "no instrument of the library fits to it for the test of trackability");
}

/** Forces on the catheter while its tip passes the bend. */
struct Tracking
{
  std::vector<double> advance;     ///< [N]
  std::vector<double> withdrawal;  ///< [N]
};

}  // namespace

BenchTest trackabilityTest(const instrument::Instrument& instrument, const SpecimenChoice& choice)
{
  const Pair pair = pairOf(instrument, choice);
  const rod::Section& wire = pair.wireSection();
  const rod::Section& catheter = pair.catheterSection();
  const scene::Scene base = benchScene(kScene);
  const double own_clearance =
      base.vessel->tube->radius - base.instruments.back().instrument.wire.sections.front().radius;
  BenchSession session(
      kScene,
      {"instruments.0.instrument=" + shaftSpecimen(pair.wire, "wire", pair.wire_from_tip, base.longest()),
       "instruments.1.instrument=" + shaftSpecimen(pair.catheter, "catheter", pair.catheter_from_tip, base.longest()),
       setting("vessel.tube.radius", catheter.radius + own_clearance)});
  const vessel::TubeShape& tube = *session.scene().vessel->tube;
  const double begin = tube.pieces[0].length;
  const double bend = tube.pieces[1].length;
  const double curvature = sharpestCurvature(tube);
  const double friction = std::isnan(catheter.friction) ? session.scene().vessel->friction : catheter.friction;

  Tracking found;
  results::SvgPlot plot;
  plot.title = "Force at the catheter";
  plot.abscissa = "inserted length [mm]";
  plot.ordinate = "force [N]";
  plot.lines = {{"advance", results::colour(0), {}},
                {"withdrawal", results::colour(1), {}},
                {"statics, advance", results::colour(2), {}},
                {"statics, withdrawal", results::colour(3), {}}};
  plot.bands = {{"bend", 1e3 * begin, 1e3 * (begin + bend)}};
  double last = session.observe().hand(1).insertion;
  while (!session.isOver())
  {
    session.runTo(session.time() + kInterval);
    const simulation::HandState hand = session.observe().hand(1);
    const bool moves = std::abs(hand.insertion - last) > 1e-6;
    const bool advances = hand.insertion > last;
    last = hand.insertion;
    if (!moves || hand.insertion < 5e-3)
      continue;
    plot.lines[advances ? 0 : 1].points.emplace_back(1e3 * hand.insertion, hand.force);
    const double share = (hand.insertion - begin) / bend;
    if (share > kFrom && share < kTo)
      (advances ? found.advance : found.withdrawal).push_back(hand.force);
  }

  ChannelProblem problem;
  problem.pieces = tube.pieces;
  problem.clearance = meanRadius(tube) - catheter.radius;
  problem.bending_stiffness = catheter.bending_stiffness + wire.bending_stiffness;
  problem.friction = friction;
  problem.tail_stiffness = wire.bending_stiffness;
  problem.tail_clearance = meanRadius(tube) - wire.radius;
  Tracking expected;
  for (int k = 0; k < kReferences; ++k)
  {
    problem.inserted_length = begin + bend * (kFrom + (kTo - kFrom) * (k + 0.5) / kReferences);
    problem.tail_length = session.observe().hand(0).insertion - problem.inserted_length;
    problem.advance = 1.0;
    expected.advance.push_back(trackingForce(problem));
    plot.lines[2].points.emplace_back(1e3 * problem.inserted_length, expected.advance.back());
    problem.advance = -1.0;
    expected.withdrawal.push_back(trackingForce(problem));
    plot.lines[3].points.emplace_back(1e3 * problem.inserted_length, expected.withdrawal.back());
  }

  BenchTest test;
  test.name = kScene;
  test.heading = "Trackability";
  test.conditions = formatted(
      "Shaft of %s (EI %.4g N·mm²) over a straight guidewire (EI %.4g N·mm²) through a bend of %.0f° and %.0f mm; "
      "clearance "
      "in the channel %.3g mm, friction %.3g. Means while the tip passes the bend from %.0f to %.0f %%.",
      instrument.inner_radius > 0.0 ? "the catheter" : "a catheter", 1e6 * catheter.bending_stiffness,
      1e6 * wire.bending_stiffness, totalTurn(tube) / units::kDegree, 1e3 / curvature, 1e3 * problem.clearance,
      friction, 100.0 * kFrom, 100.0 * kTo);
  const double in = meanOf(found.advance);
  const double out = meanOf(found.withdrawal);
  const std::string brute = "brute force: derivative of the least energy, and μ ΣN, of statics in the channel";
  test.rows = {
      {"force of advance", in, "N", meanOf(expected.advance), brute},
      {"force of withdrawal", out, "N", meanOf(expected.withdrawal), brute},
      {"elastic part: half their sum", 0.5 * (in + out), "N", 0.5 * catheter.bending_stiffness * curvature * curvature,
       "½ EI/R² of the catheter, for a clearance much smaller than R"}};
  test.plots = {plot};
  return test;
}

}  // namespace endovascular_sim::benchmark
