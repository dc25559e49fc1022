#include <algorithm>
#include <cmath>

#include "benchmark/sheet/bench_session.h"
#include "benchmark/sheet/bench_tests.h"
#include "benchmark/sheet/specimen.h"
#include "benchmark/sheet/tip_column.h"
#include "common/text/format.h"
#include "common/units.h"

namespace endovascular_sim::benchmark
{
namespace
{

constexpr double kInterval = 0.01;                     // s between two points of a curve
constexpr double kDeflection = 2e-3;                   // m, of a tip load by definition
constexpr double kFurther = 1.3;                       // largest force over that of the deflection
constexpr double kPerturbation = 2e-5;                 // of the buckling load, across the wire
constexpr double kGramForce = 1e-3 * units::kGravity;  // N

/** Length of wire beyond the clamp of a scene, which acts at the middle of the first edge [m]. */
double freeLength(const scene::Scene& scene)
{
  return scene.longest() * (scene.sampling.nodes - 1.5) / (scene.sampling.nodes - 1);
}

std::string conditionsOf(const instrument::Instrument& instrument, double length)
{
  return formatted("Distal %.3g mm, straightened and clamped; EI of the tip %.4g N·mm².", 1e3 * length,
                   1e6 * stiffnessFromTip(instrument.wire, 0.0));
}

}  // namespace

BenchTest tipLoadTest(const instrument::Instrument& instrument)
{
  const scene::Scene base = benchScene("bench_tip_load");
  const double length = freeLength(base);
  const double euler = columnLoad(instrument.wire, length);
  BenchSession session(base.name,
                       {"instrument=" + tipSpecimen(instrument, "tip", base.longest()),
                        setting("loads.point_loads.0.force", Eigen::Vector3d(0.0, kPerturbation * euler, 0.0))});
  BenchTest test;
  test.name = base.name;
  test.heading = "Tip load: column force against a plate";
  test.conditions = conditionsOf(instrument, length) + " The tip does not slip on the plate, which advances by 0.1 mm.";
  results::SvgPlot plot;
  plot.title = "Column force of the tip";
  plot.abscissa = "advance of the plate [mm]";
  plot.ordinate = "force [gf]";
  plot.lines = {{"simulation", results::colour(0), {}}, {"Euler", results::colour(1), {}}};
  while (!session.isOver())
  {
    session.runTo(session.time() + kInterval);
    const double advance = -1e3 * session.scene().distal.displacement.at(session.time());
    plot.lines[0].points.emplace_back(advance, session.simulation().state().distal_force.x() / kGramForce);
    plot.lines[1].points.emplace_back(advance, euler / kGramForce);
  }
  test.rows = {{"column force of the buckled tip", plot.lines[0].points.back().second, "gf", euler / kGramForce,
                "Euler load, clamped and pinned: 20.19 EI/ℓ² for a uniform tip"}};
  test.plots = {plot};
  return test;
}

BenchTest tipFlexibilityTest(const instrument::Instrument& instrument)
{
  const scene::Scene base = benchScene("bench_tip_flexibility");
  const double length = freeLength(base);
  const double expected = cantileverForce(instrument.wire, length, kDeflection);
  BenchSession session(base.name,
                       {"instrument=" + tipSpecimen(instrument, "tip", base.longest()),
                        setting("loads.point_loads.0.force", Eigen::Vector3d(0.0, kFurther * expected, 0.0))});
  BenchTest test;
  test.name = base.name;
  test.heading = "Tip load: force across the tip";
  test.conditions = conditionsOf(instrument, length) + " A force across the tip grows slowly.";
  results::SvgPlot plot;
  plot.title = "Force across the tip";
  plot.abscissa = "deflection [mm]";
  plot.ordinate = "force [gf]";
  plot.lines = {{"simulation", results::colour(0), {}}};
  double force_at = 0.0;
  double last_deflection = 0.0;
  double last_force = 0.0;
  while (!session.isOver())
  {
    session.runTo(session.time() + kInterval);
    const scene::PointLoad& load = session.scene().loads.point_loads.front();
    const double force = load.force.y() * std::min(1.0, session.time() / load.ramp_time);
    const double deflection = session.simulation().state().position.back().y();
    if (last_deflection < kDeflection && deflection >= kDeflection)
      force_at = last_force + (force - last_force) * (kDeflection - last_deflection) / (deflection - last_deflection);
    last_deflection = deflection;
    last_force = force;
    plot.lines[0].points.emplace_back(1e3 * deflection, force / kGramForce);
  }
  test.rows = {{"force at a deflection of 2 mm", force_at / kGramForce, "gf", expected / kGramForce,
                "exact elastica of a cantilever by shooting; 3 EI δ/ℓ³ at small δ"}};
  test.plots = {plot};
  return test;
}

}  // namespace endovascular_sim::benchmark
