#include "benchmark/studies/reference_rows.h"

#include <cmath>

#include "benchmark/reference/reference_motion.h"
#include "benchmark/reference/reference_shapes.h"
#include "benchmark/reference/reference_table.h"
#include "benchmark/reference/reference_torque.h"

namespace endovascular_sim::benchmark
{
namespace
{

void addBuckling(Table& table, bool quick)
{
  const std::vector<int> counts = quick ? std::vector<int>{27, 51} : std::vector<int>{27, 51, 101};
  addRows(table, {"post-buckling at 10 % end shortening: PL²/EI", "kkt", kBuckledForce}, counts, true,
          [](int nodes)
          {
            const Buckled buckled = buckle(nodes);
            return Measured{buckled.force, buckled.step_us, ""};
          });
  addRows(table, {"post-buckling at 10 % end shortening: deflection / L", "kkt", kBuckledDeflection}, counts, true,
          [](int nodes)
          {
            const Buckled buckled = buckle(nodes);
            return Measured{buckled.deflection, buckled.step_us, ""};
          });
  for (const char* scheme : {"paper", "mixed"})
    addReason(table, {"post-buckling at 10 % end shortening: PL²/EI", scheme, kBuckledForce},
              "no displacement of a distal end");
}

void addTwistBuckling(Table& table, bool quick)
{
  addRows(table, {"critical twist of a ring, 2π√3 EI/GJ", "statics", 2.0 * M_PI * std::sqrt(3.0)},
          quick ? std::vector<int>{32, 64} : std::vector<int>{32, 64, 128}, true,
          [](int nodes) {
            return Measured{criticalTwist(nodes), 0.0, ""};
          });
  const auto measured = [](const LocalisedHelix& helix) {
    return Measured{helix.envelope_error, helix.step_us, helix.converged ? "" : "not at rest"};
  };
  const std::string quantity = "localised helix, 27 turns: largest error of its envelope tanh²(s/s*)";
  const std::vector<int> counts = quick ? std::vector<int>{301, 601} : std::vector<int>{301, 601, 1201};
  addRows(table, {quantity, "statics", 0.0, 0.01}, counts, true,
          [&](int nodes) { return measured(localisedHelix(nodes)); });
  addRows(table, {quantity, "kkt", 0.0, 0.01}, counts, true,
          [&](int nodes) { return measured(localisedHelixInSteps(nodes)); });
  for (const char* scheme : {"paper", "mixed"})
    addReason(table, {quantity, scheme, 0.0, 0.01}, "no prescribed twist of a distal end");
}

void addTorque(Table& table)
{
  const std::vector<int> counts = {22, 42, 82};
  const double degree = 1.0;
  addRows(table,
          {"proximal angle for 60° at the tip, √(EIκκ0/GJ)L = 1 [°]", "twist", 85.69151950722886,
           degree / 85.69151950722886},
          counts, true,
          [](int nodes) {
            return Measured{Transmission(1.0, nodes).proximalAngleFor(60.0 * kDegree) / kDegree, 0.0, ""};
          });
  addRows(table,
          {"proximal angle for 90° at the tip, √(EIκκ0/GJ)L = 2 [°]", "twist", 191.78227469332728,
           degree / 191.78227469332728},
          counts, true,
          [](int nodes) {
            return Measured{Transmission(2.0, nodes).proximalAngleFor(90.0 * kDegree) / kDegree, 0.0, ""};
          });
  addRows(table,
          {"proximal angle of the snap-through, √(EIκκ0/GJ)L = 2 [°]", "twist", 197.7856142522825,
           2.0 * degree / 197.7856142522825},
          counts, true,
          [](int nodes) {
            return Measured{Transmission(2.0, nodes).snapThrough() / kDegree, 0.0, ""};
          });
}

void addVibration(Table& table, bool quick)
{
  constexpr double kTurn = 0.1;
  for (const std::string& scheme : schemes())
  {
    const std::vector<int> counts = scheme == "mixed" ? std::vector<int>{9, 17}
                                    : quick           ? std::vector<int>{26, 51}
                                                      : std::vector<int>{26, 51, 101};
    addRows(table, {"first frequency of the cantilever over the beam's", scheme, 1.0, 0.01}, counts, true,
            [&](int nodes)
            {
              const Propagation swung = swing(scheme, nodes, kTurn);
              return Measured{std::tan(swung.angle) / kTurn, swung.step_us, ""};
            });
    addRows(table, {"backward Euler's growth per step at ωΔt = 0.1", scheme, 0.9950371902, 1e-6}, {counts.back()},
            false,
            [&](int nodes)
            {
              const Propagation swung = swing(scheme, nodes, kTurn);
              return Measured{swung.growth, swung.step_us, ""};
            });
  }
}

}  // namespace

void addReferenceRows(Section& section, const StudyOptions& options, const Progress& progress)
{
  section.text =
      "`statics` is an independent solver of the same discrete rod (Newton with the exact Hessian, KLU). `twist` is "
      "the quasi-static twist of `kkt` and `paper` on a prescribed planar centreline. Frequencies are phases per step "
      "of the vibrating tip at ωΔt = 0.1. The exact growth of backward Euler is that at the frequency of the beam.";
  progress(0.0, "post-buckling");
  addBuckling(section.table, options.quick);
  progress(0.4, "torsional buckling");
  addTwistBuckling(section.table, options.quick);
  progress(0.7, "torque transmission");
  addTorque(section.table);
  progress(0.9, "vibration");
  addVibration(section.table, options.quick);
}

}  // namespace endovascular_sim::benchmark
