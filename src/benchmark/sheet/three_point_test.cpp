#include <algorithm>
#include <cmath>

#include "benchmark/sheet/bench_session.h"
#include "benchmark/sheet/bench_tests.h"
#include "benchmark/sheet/roller_elastica.h"
#include "benchmark/sheet/specimen.h"
#include "common/text/format.h"

namespace endovascular_sim::benchmark
{
namespace
{

constexpr const char* kScene = "bench_three_point";
constexpr double kInterval = 0.02;   // s between two points of the curve
constexpr std::size_t kLoading = 2;  // index of the loading roller; the supports are 0 and 1

/** State of the wire on the rollers. */
struct Reading
{
  double deflection = 0.0;  ///< of the wire's middle against the supports [m]
  double force = 0.0;       ///< of the loading roller [N]
};

/** The displacement of the loading roller, less the depths of the contacts: a testing machine's own compliance is
 *  subtracted in the same way. */
Reading read(BenchSession& session)
{
  std::vector<double> depth(session.scene().rollers.size(), 0.0);
  for (const contact::Feature& feature : session.observe().contacts().features)
    depth[feature.triangle] = std::max(depth[feature.triangle], -feature.gap);
  Reading reading;
  reading.deflection =
      session.scene().rollers[kLoading].displacement.at(session.time()) - depth[kLoading] - 0.5 * (depth[0] + depth[1]);
  for (const Eigen::Vector3d& force : session.simulation().state().wall_force)
    reading.force += std::max(0.0, -force.y());
  return reading;
}

/** Overrides that place the rollers about a wire of another radius, and the wire with its overhang. */
std::vector<std::string> setUp(const instrument::Instrument& instrument, double from_tip, const scene::Scene& base)
{
  const double length = base.longest();
  const double reach = base.rollers[0].radius + sectionFromTip(instrument.wire, from_tip).radius;
  std::vector<std::string> overrides = {"instrument=" + shaftSpecimen(instrument, "specimen", from_tip, length)};
  for (std::size_t k = 0; k < base.rollers.size(); ++k)
  {
    Eigen::Vector3d position = base.rollers[k].position;
    position.y() = k == kLoading ? reach : -reach;
    overrides.push_back(setting("rollers." + std::to_string(k) + ".position", position));
  }
  return overrides;
}

/** Curve of the simulation beside the exact one. */
results::SvgPlot curvesOf(const std::vector<Reading>& readings, const ThreePointBend& bend)
{
  results::SvgPlot plot;
  plot.title = "Three-point bending";
  plot.abscissa = "deflection [mm]";
  plot.ordinate = "force [N]";
  plot.lines = {{"simulation", results::colour(0), {}},
                {"exact elastica", results::colour(1), {}},
                {"48 EI δ/L³", results::colour(2), {}}};
  for (const Reading& reading : readings)
  {
    plot.lines[0].points.emplace_back(1e3 * reading.deflection, reading.force);
    plot.lines[1].points.emplace_back(1e3 * reading.deflection, elasticaForce(bend, reading.deflection));
    plot.lines[2].points.emplace_back(1e3 * reading.deflection, beamForce(bend, reading.deflection));
  }
  return plot;
}

}  // namespace

BenchTest threePointTest(const instrument::Instrument& instrument, const SpecimenChoice& choice,
                         const std::vector<std::string>& overrides)
{
  const double from_tip = std::isnan(choice.from_tip) ? middleOfShaft(instrument.wire) : choice.from_tip;
  const rod::Section& section = sectionFromTip(instrument.wire, from_tip);
  std::vector<std::string> all = setUp(instrument, from_tip, benchScene(kScene));
  all.insert(all.end(), overrides.begin(), overrides.end());
  BenchSession session(kScene, all);
  const std::vector<scene::RollerScene>& rollers = session.scene().rollers;
  const ThreePointBend bend{rollers[1].position.x() - rollers[0].position.x(), section.bending_stiffness,
                            rollers[0].radius + section.radius};
  const std::vector<scene::DriveProfile::Point>& motion = rollers[kLoading].displacement.points;
  session.runTo(motion[2].time);
  const Reading small = read(session);
  std::vector<Reading> curve;
  for (double time = motion[2].time + kInterval; time < motion[3].time; time += kInterval)
  {
    session.runTo(time);
    curve.push_back(read(session));
  }
  session.runTo(session.scene().duration);
  const Reading large = read(session);
  curve.push_back(large);

  BenchTest test;
  test.name = kScene;
  test.heading = "Three-point bending";
  test.conditions = formatted(
      "Straight specimen of the section %.0f mm from the tip, EI %.4g N·mm²; span %.0f mm, rollers "
      "of %.2f mm without friction.",
      1e3 * from_tip, 1e6 * section.bending_stiffness, 1e3 * bend.span, 1e3 * rollers[0].radius);
  const double stiffness = small.force * std::pow(bend.span, 3) / (48.0 * small.deflection);
  const double area_moment = M_PI / 4.0 * (std::pow(section.radius, 4) - std::pow(instrument.inner_radius, 4));
  test.rows = {{"bending stiffness EI", 1e6 * stiffness, "N·mm²", 1e6 * section.bending_stiffness,
                "EI of the file, by F = 48 EI δ/L³ at δ = L/1000"},
               {"flexural modulus E", 1e-9 * stiffness / area_moment, "GPa",
                1e-9 * section.bending_stiffness / area_moment, "E of a homogeneous section with the EI of the file"},
               {formatted("force at a deflection of %.3g mm", 1e3 * large.deflection), large.force, "N",
                elasticaForce(bend, large.deflection), "exact elastica on rollers"}};
  test.plots = {curvesOf(curve, bend)};
  return test;
}

}  // namespace endovascular_sim::benchmark
