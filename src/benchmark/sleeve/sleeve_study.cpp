#include "benchmark/sleeve/sleeve_study.h"

#include <algorithm>
#include <cmath>

#include "benchmark/sleeve/sleeve_elastica.h"
#include "benchmark/sleeve/sleeve_runs.h"

namespace endovascular_sim::benchmark
{
namespace
{

std::vector<double> lengths(bool quick)
{
  if (quick)
    return {1.1, 1.5, 2.0, 2.4};
  return {1.05, 1.1, 1.2, 1.3, 1.4, 1.5, 1.6, 1.8, 1.95, 2.0, 2.05, 2.1, 2.2, 2.4, 2.6, 2.8, 2.98};
}

/** Inserted length at which the force changes its sign, by linear interpolation; NaN without. */
double signChange(const std::vector<SleeveForce>& forces)
{
  for (std::size_t k = 0; k + 1 < forces.size(); ++k)
    if (forces[k].force > 0.0 && forces[k + 1].force <= 0.0)
      return forces[k].length +
             (forces[k + 1].length - forces[k].length) * forces[k].force / (forces[k].force - forces[k + 1].force);
  return NAN;
}

void addRun(const SleeveMotion& motion, std::vector<Section>& sections)
{
  SleeveElastica elastica;
  const SleeveCurve curve = runSleeve(motion);
  const std::string guide = number(1e3 * motion.guide_length);
  for (const auto& [way, forces] : {std::pair("in", &curve.in), std::pair("out", &curve.out)})
  {
    double largest = 0.0;
    double of_tolerance = 0.0;
    for (const SleeveForce& found : *forces)
    {
      elastica.moveTo(found.length);
      const double exact = elastica.handForce();
      const double error = std::abs(found.force - exact);
      largest = std::max(largest, error);
      of_tolerance = std::max(of_tolerance, error / (0.15 + 0.03 * std::abs(exact)));
      sections[0].table.add({guide, std::to_string(motion.nodes), way, number(found.length, 4), number(found.force, 5),
                             number(exact, 5), number(elastica.axialForce(), 5), number(found.configurational, 5)});
    }
    sections[1].table.add({guide, std::to_string(motion.nodes), way, number(largest), number(of_tolerance),
                           number(signChange(*forces), 4)});
  }
}

}  // namespace

std::vector<TableSpec> sleeveTables()
{
  return {{"sleeve",
           "Rod pushed through a sleeve towards a pin",
           {"guide [mm]", "nodes", "way", "inserted length / L", "force", "exact force", "exact axial force",
            "configurational force"},
           ""},
          {"sleeve_errors",
           "Rod pushed through a sleeve: largest errors",
           {"guide [mm]", "nodes", "way", "largest error", "largest error over 0.15 + 3 %", "sign change at / L"},
           ""}};
}

std::vector<Section> sleeveStudy(const StudyOptions& options, const Progress& progress)
{
  std::vector<Section> sections = {Section(sleeveTables(), "sleeve"), Section(sleeveTables(), "sleeve_errors")};
  sections[0].text =
      "A rod (EI = 1 mN·m²) is pushed through the introducer towards a pin on its axis at L = 0.2 m, and withdrawn "
      "(Bosi et al. 2015). Forces over EI/L². Exact: elastica by shooting; the hand needs the axial force in the rod "
      "less the configurational force ½EIκ² at the sleeve, and must pull from 2.04 L on.";
  sections[1].text = "Largest errors over all inserted lengths of `sleeve.csv`.";
  const std::vector<double> at = lengths(options.quick);
  const std::vector<double> guides =
      options.quick ? std::vector<double>{19e-3} : std::vector<double>{12e-3, 19e-3, 30e-3};
  const std::vector<int> counts = options.quick ? std::vector<int>{241} : std::vector<int>{241, 341, 481};
  double done = 0.0;
  for (const double guide : guides)
    for (const int nodes : counts)
    {
      progress(done / static_cast<double>(guides.size() * counts.size()),
               "guide " + number(1e3 * guide) + " mm, " + std::to_string(nodes) + " nodes");
      SleeveMotion motion;
      motion.guide_length = guide;
      motion.nodes = nodes;
      motion.lengths = at;
      addRun(motion, sections);
      done += 1.0;
    }
  return sections;
}

}  // namespace endovascular_sim::benchmark
