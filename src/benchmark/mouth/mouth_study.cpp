#include "benchmark/mouth/mouth_study.h"

#include <cmath>
#include <optional>

#include "benchmark/mouth/mouth_runs.h"

namespace endovascular_sim::benchmark
{
namespace
{

constexpr double kRow = 1e-3;  // distance between the rows of the table [m]

/** Force on a way at an inserted length, of the nearest step. */
double forceAt(const std::vector<MouthForce>& way, double insertion)
{
  const MouthForce* nearest = &way.front();
  for (const MouthForce& at : way)
    if (std::abs(at.insertion - insertion) < std::abs(nearest->insertion - insertion))
      nearest = &at;
  return nearest->force;
}

std::vector<MouthMotion> motionsOf(bool quick)
{
  MouthMotion guide;
  guide.instrument = "guide_6f_jl4";
  guide.travel = 0.13;
  std::vector<MouthMotion> motions = {guide};
  if (quick)
    return motions;
  const auto add = [&motions](MouthMotion motion, auto change)
  {
    change(motion);
    motions.push_back(std::move(motion));
  };
  for (const double speed : {1e-3, 5e-3, 100e-3})
    add(guide, [speed](MouthMotion& motion) { motion.speed = speed; });
  for (const int nodes : {902, 451, 301})
    add(guide, [nodes](MouthMotion& motion) { motion.nodes = nodes; });
  add(guide, [](MouthMotion& motion) { motion.bend_curvature = 20.0; });
  for (const char* name : {"catheter_6f_jr4", "catheter_6f_pigtail", "guidewire_035_angled", "guidewire_035_j"})
    add(guide,
        [name](MouthMotion& motion)
        {
          motion.instrument = name;
          motion.travel = 0.1;
        });
  // The loop leaves its plane beyond 24 mm. Where its tip touches the tube the force has a kink.
  motions[motions.size() - 3].travel = 0.04;
  motions[motions.size() - 3].reference_step = 0.05e-3;
  return motions;
}

}  // namespace

std::vector<TableSpec> mouthTables()
{
  return {
      {"mouth",
       "Introducer's mouth: force at the hand",
       {"instrument", "nodes", "speed [mm/s]", "tube", "inserted length [mm]", "reference [N]", "in [N]", "out [N]"},
       "mouth.png"},
      {"mouth_errors",
       "Introducer's mouth: largest deviations",
       {"instrument", "nodes", "speed [mm/s]", "tube", "way", "largest deviation [mN]", "at [mm]",
        "deviation over 20 mN + 3 %", "change per ms beyond the reference's [mN]", "out of the plane from [mm]",
        "to [mm]"},
       ""}};
}

std::vector<Section> mouthStudy(const StudyOptions& options, const Progress& progress)
{
  std::vector<Section> sections = {Section(mouthTables(), "mouth"), Section(mouthTables(), "mouth_errors")};
  sections[0].text =
      "A curved instrument is pushed out of the introducer into a frictionless tube of 8 mm, and withdrawn. Reference: "
      "derivative of the least energy of quasi-static equilibria with edges of 0.1 mm, by another solver.";
  sections[1].text =
      "Largest deviations of `mouth.csv` over all steps of 1 ms. The reference is plane: a wire that has left the "
      "plane of "
      "its rest curvature is not compared.";
  const std::vector<MouthMotion> motions = motionsOf(options.quick);
  for (std::size_t k = 0; k < motions.size(); ++k)
  {
    const MouthMotion& motion = motions[k];
    const std::string nodes = motion.nodes > 0 ? std::to_string(motion.nodes) : "adaptive";
    const std::string speed = number(1e3 * motion.speed);
    const std::string tube = motion.bend_curvature != 0.0 ? "bent" : "straight";
    progress(static_cast<double>(k) / static_cast<double>(motions.size()),
             motion.instrument + ", " + nodes + " nodes, " + speed + " mm/s");
    const MouthCurves curves = runMouth(motion);
    for (std::size_t row = 0; row < curves.reference.size();
         row += static_cast<std::size_t>(std::lround(kRow / motion.reference_step)))
    {
      const MouthForce& at = curves.reference[row];
      sections[0].table.add({motion.instrument, nodes, speed, tube, number(1e3 * at.insertion, 5), number(at.force, 4),
                             number(forceAt(curves.in, at.insertion), 4),
                             number(forceAt(curves.out, at.insertion), 4)});
    }
    for (const auto& [way, forces] : {std::pair("in", &curves.in), std::pair("out", &curves.out)})
    {
      const MouthDeviation found = deviationOf(*forces, curves.reference);
      const std::optional<PlaneLeft> left = planeLeft(*forces);
      sections[1].table.add({motion.instrument, nodes, speed, tube, way, number(1e3 * found.largest),
                             number(1e3 * found.at), number(found.of_tolerance), number(1e3 * found.change),
                             left ? number(1e3 * left->from, 4) : "", left ? number(1e3 * left->to, 4) : ""});
    }
  }
  return sections;
}

}  // namespace endovascular_sim::benchmark
