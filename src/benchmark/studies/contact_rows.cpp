#include "benchmark/studies/contact_rows.h"

#include <map>

#include "benchmark/reference/reference_contact.h"
#include "benchmark/reference/reference_table.h"
#include "benchmark/reference/reference_tube_buckling.h"

namespace endovascular_sim::benchmark
{
namespace
{

/** Numbers of nodes of a scheme: `mixed` requires fewer, and `paper`, which is slow here, is run with one. */
std::vector<int> counts(const std::string& scheme, const std::vector<int>& kkt, const std::vector<int>& mixed)
{
  if (scheme == "paper")
    return {kkt.front()};
  return scheme == "mixed" ? mixed : kkt;
}

void addCapstan(Table& table, const std::string& scheme)
{
  const std::vector<double> speeds = scheme == "paper" ? std::vector<double>{0.2, 2.0} : std::vector<double>{0.02};
  for (const double speed : speeds)
    addRows(table,
            {"capstan with bending stiffness, EI/(T1R²) = 0.1, drawn at " + number(speed) + " m/s: T2/T1", scheme,
             kCapstanRatio, 0.01},
            counts(scheme, {59, 117}, {30, 59}), false, [&](int nodes) { return capstanRatio(scheme, nodes, speed); });
}

void addInsertion(Table& table, const std::string& scheme)
{
  const std::vector<int> nodes_of_rows = counts(scheme, {81, 161}, {41, 81});
  std::map<int, Insertion> runs;
  for (int nodes : nodes_of_rows)
    runs[nodes] = insertIntoABend(scheme, nodes);
  addRows(table, {"hand force of an insertion while a bend fills, over ½EIκ²", scheme, 1.0, 0.05}, nodes_of_rows, false,
          [&](int nodes) {
            return Measured{runs[nodes].filling, runs[nodes].step_us, runs[nodes].note};
          });
  addRows(table, {"hand force of an insertion after the tip has left the bend, over ½EIκ²", scheme, 0.0, 0.02},
          nodes_of_rows, false,
          [&](int nodes) {
            return Measured{runs[nodes].beyond, runs[nodes].step_us, runs[nodes].note};
          });
}

void addTubeBuckling(Table& table, const std::string& scheme)
{
  addRows(table, {"buckling in a straight tube, F/√(EI q/r), L = 10 (EI r/q)^¼", scheme, kTubeBuckling, 0.1},
          counts(scheme, {41, 81}, {21, 41}), false, [&](int nodes) { return buckleInATube(scheme, nodes); });
  const Reference bent{"buckling in a bent tube, F r R/(4 EI)", scheme, 1.0, 0.1};
  if (scheme == "mixed")
    addReason(table, bent, "clamps a distal end along the initial direction only");
  else
    addRows(table, bent, counts(scheme, {62, 122}, {}), false,
            [&](int nodes) { return buckleInABentTube(scheme, nodes); });
}

}  // namespace

void addContactRows(Section& section, const Progress& progress)
{
  section.text =
      "Walls in closed form with contact at the nodes, which exclude effects of facets.\n\n"
      "- Insertion: a straight wire of EI = 300 N·mm² enters a bend of 90° and 30 mm radius at 50 mm/s; means over 10 "
      "mm of travel. The clearance is a hundredth of the radius; the position within it changes the force by ± 2 %.\n"
      "- Capstan: mean over a travel of two edges. In the linear step of `paper`, friction removes at most the "
      "momentum of a node, m v/Δt, so its share is 1/(1 + Δt μ f_n/(m v)).\n"
      "- Tubes: held ends, shortened by a small lateral amplitude. The force grows with the amplitude, and between "
      "the clamps of the bent tube by 2.5 % with the finite length; both count as error.\n"
      "- Steps: the wall of `paper` yields by F Δt²/m, so its steps are 1.3 µs in the channel, 1 µs on the peg, 3 µs "
      "in the bent tube, 20 µs in the insertion and 0.1 ms in the straight tube; those of the others are 0.1 to 5 ms.";
  double done = 0.0;
  for (const std::string& scheme : schemes())
  {
    progress(done, "contact, " + scheme);
    addRows(section.table,
            {"J tip in a straight channel, k0 l = 1, h/l = 0.1: wall force F l²/EI", scheme, 1.312420794870624, 0.02},
            counts(scheme, {26, 51, 101}, {13, 26, 51}), scheme != "paper",
            [&](int nodes) { return ceilingForce(scheme, 1.0, 0.1, nodes); });
    addCapstan(section.table, scheme);
    addInsertion(section.table, scheme);
    addTubeBuckling(section.table, scheme);
    done += 1.0 / static_cast<double>(schemes().size());
  }
}

}  // namespace endovascular_sim::benchmark
