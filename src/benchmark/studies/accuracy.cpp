#include "benchmark/studies/accuracy.h"

#include <cmath>

#include "benchmark/reference/reference_table.h"
#include "benchmark/reference/static_cases.h"
#include "benchmark/studies/contact_rows.h"
#include "benchmark/studies/reference_rows.h"
#include "common/error.h"

namespace endovascular_sim::benchmark
{
namespace
{

constexpr double kAtRest = 1e-12;  // largest motion per step at rest [m]

std::vector<int> nodeCounts(const std::string& scheme, bool quick)
{
  if (scheme == "mixed")
    return quick ? std::vector<int>{7, 13, 25} : std::vector<int>{5, 9, 13, 17, 25, 49, 97};
  return quick ? std::vector<int>{25, 50, 100} : std::vector<int>{25, 50, 100, 200, 400};
}

/** Adds the rows of one problem and one scheme, coarse to fine. */
void addRows(Table& table, const StaticCase& problem, const std::string& scheme, bool quick)
{
  double previous_error = NAN;
  double previous_edges = NAN;
  for (int nodes : nodeCounts(scheme, quick))
  {
    RestResult result;
    try
    {
      result = runToRest(sceneText(atRest(problem, scheme, nodes)), kAtRest, restSteps(scheme));
    }
    catch (const InputError& error)
    {
      table.add({problem.name, scheme, "", "", "", "", std::string("rejected: ") + error.what()});
      return;
    }
    const double error = tipError(problem, result);
    const double edges = nodes - (scheme == "mixed" ? 1.0 : 1.5);
    const double order = std::log(previous_error / error) / std::log(edges / previous_edges);
    table.add({problem.name, scheme, std::to_string(nodes), number(error), number(order), number(result.step_us),
               result.settled ? "at rest after " + std::to_string(result.steps) + " steps" : "not at rest"});
    previous_error = error;
    previous_edges = edges;
  }
}

}  // namespace

std::vector<TableSpec> accuracyTables()
{
  return {{"accuracy",
           "Static shapes",
           {"problem", "scheme", "nodes", "tip error / L", "order", "µs per step", "note"},
           "accuracy.png"},
          {"accuracy_references", "Buckling, torque, vibration", referenceColumns(), ""},
          {"accuracy_contact", "Contact", referenceColumns(), ""}};
}

std::vector<Section> accuracyStudy(const StudyOptions& options, const Progress& progress)
{
  Section section(accuracyTables(), "accuracy");
  section.text =
      "Distance between the computed and the exact tip over the length of the wire, and the observed order in the "
      "edge length between consecutive rows. The clamp of `kkt` and `paper` acts at the centre of an edge: the free "
      "length is N − 3/2 edges. That of `mixed` acts at the node: N − 1 edges. The time per step is that of the run "
      "to rest, with long steps of several solves.";
  const std::vector<StaticCase> problems = staticCases();
  double done = 0.0;
  for (const StaticCase& problem : problems)
    for (const std::string& scheme : schemes())
    {
      progress(0.5 * done / static_cast<double>(problems.size() * schemes().size()), problem.name + ", " + scheme);
      addRows(section.table, problem, scheme, options.quick);
      done += 1.0;
    }
  const auto references = [&progress](double share, const std::string& what) { progress(0.5 + 0.3 * share, what); };
  const auto contact = [&progress](double share, const std::string& what) { progress(0.8 + 0.2 * share, what); };
  std::vector<Section> sections = {section};
  sections.emplace_back(accuracyTables(), "accuracy_references");
  addReferenceRows(sections.back(), options, references);
  sections.emplace_back(accuracyTables(), "accuracy_contact");
  addContactRows(sections.back(), contact);
  return sections;
}

}  // namespace endovascular_sim::benchmark
