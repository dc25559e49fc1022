#include "benchmark/coaxial/coaxial_study.h"

#include <cmath>

#include "benchmark/coaxial/coaxial_runs.h"
#include "common/units.h"

namespace endovascular_sim::benchmark
{
namespace
{

using units::kDegree;
constexpr double kRelativeTolerance = 0.03;
constexpr double kTolerance = 2e-3;  // N

struct Wire
{
  const char* name;
  double bending_stiffness;  ///< [N·m²]
  double clearance;          ///< [m]
};

std::vector<CoaxialCase> casesOf(const Wire& wire, bool quick)
{
  std::vector<CoaxialCase> cases;
  const std::vector<double> angles = quick ? std::vector<double>{90.0} : std::vector<double>{60.0, 90.0, 180.0};
  const std::vector<double> frictions = quick ? std::vector<double>{0.2} : std::vector<double>{0.05, 0.1, 0.2, 0.3};
  for (const double angle : angles)
    for (const double friction : frictions)
      for (const double tension : {0.0, 0.1, 0.375, 1.0})
        for (const bool pull : {true, false})
          cases.push_back({angle * kDegree, friction, tension, pull, wire.bending_stiffness, wire.clearance});
  return cases;
}

/** Force without bending: T e^(± μ θ), in the direction of the motion [N]. */
double capstanForce(const CoaxialCase& at)
{
  const double sign = at.pull ? 1.0 : -1.0;
  return sign * at.tip_tension * std::exp(sign * at.friction * at.angle);
}

}  // namespace

std::vector<TableSpec> coaxialTables()
{
  return {{"coaxial",
           "Friction between layers",
           {"wire", "angle [°]", "friction", "tension at the tip [N]", "motion", "force in the catheter [N]",
            "force in the tube [N]", "capstan without bending [N]", "error [mN]", "error over 3 % + 2 mN"},
           ""}};
}

std::vector<Section> coaxialStudy(const StudyOptions& options, const Progress& progress)
{
  const std::vector<Wire> wires = {{"EI 40 N·mm²", 40e-6, 4.445e-4}, {"EI 291 N·mm²", 291e-6, 4.445e-4}};
  std::vector<Section> sections = {Section(coaxialTables(), "coaxial")};
  int good = 0;
  int done = 0;
  for (const Wire& wire : wires)
  {
    const std::vector<CoaxialCase> cases = casesOf(wire, options.quick);
    for (const CoaxialCase& at : cases)
    {
      progress(static_cast<double>(done++) / static_cast<double>(wires.size() * cases.size()), wire.name);
      const double force = forceInCatheter(at);
      const double reference = forceInTube(at);
      const double relative = std::abs(force - reference) / (kRelativeTolerance * std::abs(reference) + kTolerance);
      good += relative <= 1.0;
      sections[0].table.add({wire.name, number(at.angle / kDegree), number(at.friction), number(at.tip_tension),
                             at.pull ? "pull" : "push", number(force, 4), number(reference, 4),
                             number(capstanForce(at), 4), number(1e3 * (force - reference)), number(relative)});
    }
  }
  sections[0].text =
      "Hand force on a 0.035\" wire that slides in a guiding catheter (clearance 0.44 mm) around a bend of 30 mm "
      "radius, "
      "edges of 1 mm. Reference: one wire with wall contact in a smooth tube of the catheter's bore, time step 0.2 "
      "ms. " +
      std::to_string(good) + " of " + std::to_string(done) + " cases are within 3 % + 2 mN.";
  return sections;
}

}  // namespace endovascular_sim::benchmark
