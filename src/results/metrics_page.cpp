#include "results/metrics_page.h"

#include <algorithm>
#include <functional>

#include <nlohmann/json.hpp>

#include "common/text/format.h"
#include "common/units.h"
#include "instrument/instrument.h"
#include "results/lesson_mark.h"
#include "results/svg_plot.h"

namespace endovascular_sim::results
{
namespace
{

using Json = nlohmann::ordered_json;

constexpr auto kHead = R"(<!DOCTYPE html>
<html lang="en"><head><meta charset="utf-8"><title>Session</title><style>
body { font-family: sans-serif; max-width: 920px; margin: 2em auto; color: #222; }
table { border-collapse: collapse; margin: 0.6em 0 1.6em; font-size: 14px; }
th, td { text-align: left; padding: 3px 12px 3px 0; border-bottom: 1px solid #ddd; }
td.n { text-align: right; }
h1 { font-size: 22px; } h2 { font-size: 17px; margin-top: 1.6em; }
.bad { color: #b00020; } .good { color: #1b7a2f; }
</style></head><body>
)";

std::string number(const char* format, double value)
{
  return formatted(format, value);
}

/** HTML table. Cells that begin with a digit or a minus sign are aligned as numbers. */
class Table
{
public:
  explicit Table(const std::vector<std::string>& head)
  {
    html_ = "<table><tr>";
    for (const std::string& cell : head)
      html_ += "<th>" + escaped(cell) + "</th>";
    html_ += "</tr>\n";
  }

  void add(const std::vector<std::string>& cells)
  {
    html_ += "<tr>";
    for (const std::string& cell : cells)
    {
      const bool is_number = !cell.empty() && (cell[0] == '-' || (cell[0] >= '0' && cell[0] <= '9'));
      html_ += (is_number ? "<td class=\"n\">" : "<td>") + escaped(cell) + "</td>";
    }
    html_ += "</tr>\n";
  }

  std::string text() const { return html_ + "</table>\n"; }

private:
  std::string html_;
};

std::string summary(const Json& json)
{
  std::string html = "<h1>Session: " + escaped(json["scene"].get<std::string>()) + "</h1>\n";
  if (json.contains("outcome"))
  {
    const std::string outcome = json["outcome"];
    html += "<p class=\"" + std::string(outcome == "done" ? "good" : "bad") + "\">Procedure: " + outcome;
    if (!json["failure"].is_null())
      html += ". " + escaped(json["failure"].get<std::string>());
    html += "</p>\n";
  }
  Table table({"", ""});
  table.add({"procedure time", number("%.1f s", json["procedure_time"])});
  table.add({"fluoroscopy time (while a handle moves)", number("%.1f s", json["fluoroscopy_time"])});
  table.add({"instrument exchanges", number("%.0f", json["instrument_exchanges"])});
  if (json.contains("contrast"))
    table.add({"contrast medium",
               number("%.1f ml", 1e6 * json["contrast"]["injected_volume"].get<double>()) +
                   number(" with %.2f g of iodine", 1e3 * json["contrast"]["injected_iodine"].get<double>())});
  const Json& forces = json["wall_forces"];
  if (!forces.is_null())
  {
    const Json region = forces.value("peak_region", Json(nullptr));  // null: the branches of the vessel have no names
    table.add({"largest force of one contact",
               number("%.2f N", forces["peak"]) + number(" at %.1f s", forces["peak_time"]) +
                   (region.is_string() ? " in " + region.get<std::string>() : std::string())});
    table.add({"integral of the wall forces", number("%.1f N·s", forces["integral"])});
  }
  return html + table.text();
}

/** Result of a lesson; empty without pass marks. */
std::string lessonTable(const SessionMetrics& metrics)
{
  const std::vector<Mark> marks = lessonMarks(metrics);
  if (marks.empty())
    return "";
  Table table({"mark", "session", "at most", "unit", ""});
  for (const Mark& mark : marks)
    table.add({mark.name, number("%.3g", mark.value), number("%.3g", mark.limit), mark.unit,
               mark.passed ? "passed" : "not passed"});
  const bool passed = std::all_of(marks.begin(), marks.end(), [](const Mark& mark) { return mark.passed; });
  return "<h2 class=\"" + std::string(passed ? "good" : "bad") + "\">" + escaped(verdict(marks, stepsBefore(metrics))) +
         "</h2>\n" + table.text();
}

std::string stepsTable(const Json& json)
{
  if (json["steps"].empty())
    return "";
  Table table({"phase", "step", "begin [s]", "end [s]", "retries", "wrong branches", "outcome"});
  for (const Json& step : json["steps"])
    table.add({step["phase"], step["step"], number("%.1f", step["begin"]), number("%.1f", step["end"]),
               number("%.0f", step["retries"]), number("%.0f", step["wrong_branches"]), step["outcome"]});
  return "<h2>Steps</h2>\n" + table.text();
}

std::string instrumentsTable(const Json& json)
{
  Table table({"instrument", "insertions", "tip path [mm]", "smoothness (SPARC)", "wrong branches",
               "time in wrong branches [s]", "time ahead of its wire [s]", "peak hand force [N]"});
  for (const Json& one : json["instruments"])
    table.add({one["name"], number("%.0f", one["insertions"]), number("%.0f", 1e3 * one["tip_path"].get<double>()),
               number("%.2f", one["spectral_arc_length"]), number("%.0f", one["wrong_branch_entries"]),
               number("%.1f", one["wrong_branch_time"]), number("%.1f", one["time_ahead_of_wire"]),
               number("%.2f", one["peak_hand_force"])});
  return "<h2>Instruments</h2>\n" + table.text();
}

std::string lesionsTable(const Json& json)
{
  if (json["lesions"].empty())
    return "";
  Table table({"lesion in", "stenosis before", "after", "covered by the stent", "placement error [mm]", "apposition"});
  for (const Json& one : json["lesions"])
  {
    const Json& after = one["after"];
    const bool stented = after.contains("coverage");
    const auto percent = [](const Json& share) { return number("%.0f %%", 100.0 * share.get<double>()); };
    table.add({one["branch"], percent(one["before"]["stenosis"]), percent(after["stenosis"]),
               stented ? percent(after["coverage"]) : "no stent",
               stented ? number("%.1f", 1e3 * after["placement_error"].get<double>()) : "",
               stented ? percent(after["apposition"]) : ""});
  }
  return "<h2>Lesions</h2>\n" + table.text();
}

/** Pd/Pa at rest and fractional flow reserve of lesions, by the pressures in the vessel and by pressure wires. */
std::string pressureTable(const Json& json)
{
  if (!json.contains("pressure"))
    return "";
  const auto ratio = [](const Json& value) { return value.is_null() ? std::string() : number("%.2f", value); };
  Table table({"", "Pd/Pa at rest, before", "after", "FFR before", "after"});
  const auto add = [&](const std::string& name, const Json& one)
  {
    table.add({name, ratio(one["pd_pa_before"]), ratio(one["pd_pa_after"]), ratio(one["ffr_before"]),
               ratio(one["ffr_after"])});
  };
  const Json& pressure = json["pressure"];
  for (const Json& one : pressure["lesions"])
    add("lesion in " + json["lesions"].at(one["lesion"].get<std::size_t>())["branch"].get<std::string>(), one);
  for (const Json& one : pressure["wires"])
    add(one["instrument"].get<std::string>() + " behind " + one["catheter"].get<std::string>() + ", measured", one);
  return "<h2>Blood pressure</h2>\n<p>FFR: mean pressure behind a lesion divided by that before it, in hyperaemia; "
         "significant below 0.80.</p>\n" +
         table.text();
}

std::string errorTables(const Json& json)
{
  std::string html = "<h2>Wrong branches</h2>\n";
  Table wrong({"instrument", "branch", "from [s]", "to [s]", "deepest [mm]"});
  for (const Json& one : json["wrong_branches"])
    wrong.add({one["instrument"], one["branch"], number("%.1f", one["begin"]), number("%.1f", one["end"]),
               number("%.1f", 1e3 * one["deepest"].get<double>())});
  html += json["wrong_branches"].empty() ? "<p class=\"good\">None.</p>\n" : wrong.text();
  html += "<h2>Errors of the trainee</h2>\n";
  Table errors({"error", "instrument", "at [s]", "value"});
  for (const Json& one : json["errors"])
    errors.add({one["error"], one["instrument"], number("%.1f", one["time"]),
                one.contains("value") ? number("%.3g", one["value"]) : ""});
  return html + (json["errors"].empty() ? "<p class=\"good\">None.</p>\n" : errors.text());
}

/** Table of the faults of the simulator; empty without a fault. */
std::string faultsTable(const Json& json)
{
  if (json["simulator_faults"].empty())
    return "";
  Table table({"fault", "from [s]", "to [s]", "steps"});
  for (const Json& one : json["simulator_faults"])
    table.add({one["fault"], number("%.2f", one["begin"]), number("%.2f", one["end"]), number("%.0f", one["steps"])});
  return "<h2>Faults of the simulator</h2>\n<p>Forces during these times do not count as errors of the trainee.</p>\n" +
         table.text();
}

/** Remarks of the teacher, and steps that the recording lacks; empty without any. */
std::string notesTables(const SessionMetrics& metrics, const Json& json)
{
  std::string html;
  if (json.contains("marks"))
  {
    Table table({"at [s]", "remark"});
    for (const Json& one : json["marks"])
      table.add({number("%.1f", one["time"]), one["text"]});
    html += "<h2>Remarks of the teacher</h2>\n" + table.text();
  }
  if (json.contains("gaps"))
  {
    const double time_step = metrics.scene().solver.time_step;
    Table table({"first step", "last step", "from [s]", "to [s]", "bag before", "bag after"});
    for (const Json& one : json["gaps"])
      table.add({number("%.0f", one["first_step"]), number("%.0f", one["last_step"]),
                 number("%.2f", one["first_step"].get<double>() * time_step),
                 number("%.2f", (one["last_step"].get<double>() + 1.0) * time_step), one["previous"], one["next"]});
    html +=
        "<h2>Not recorded</h2>\n<p>The recorder failed or was stopped. The simulation went on; times and errors of "
        "these "
        "steps are missing on this page.</p>\n" +
        table.text();
  }
  return html;
}

using Quantity = std::function<double(const Sample&, std::size_t)>;

std::vector<PlotLine> overTime(const SessionMetrics& metrics, const Quantity& quantity)
{
  std::vector<PlotLine> lines;
  for (std::size_t k = 0; k < metrics.scene().instruments.size(); ++k)
  {
    PlotLine line{metrics.scene().instruments[k].instrument.name, colour(k), {}};
    for (const Sample& sample : metrics.samples())
      line.points.emplace_back(sample.observation.time, quantity(sample, k));
    lines.push_back(std::move(line));
  }
  return lines;
}

/** One band per phase. A step without a phase belongs to the previous phase. */
std::vector<PlotBand> phaseBands(const SessionMetrics& metrics)
{
  std::vector<PlotBand> bands;
  for (const procedure::StepRecord& step : metrics.steps())
    if (!bands.empty() && bands.back().name == step.phase)
      bands.back().end = step.end;
    else
      bands.push_back({step.phase, step.begin, step.end});
  return bands;
}

std::string timePlots(const SessionMetrics& metrics)
{
  const auto plot = [&metrics](const std::string& title, const std::string& ordinate, std::vector<PlotLine> lines)
  {
    SvgPlot svg;
    svg.title = title;
    svg.abscissa = "time [s]";
    svg.ordinate = ordinate;
    svg.lines = std::move(lines);
    svg.bands = phaseBands(metrics);
    return svg.text();
  };
  const auto hand = [](const Sample& sample, std::size_t k) -> const simulation::HandState&
  { return sample.observation.instruments[k].hand; };
  std::string html = "<h2>Over time</h2>\n<p>Shaded bands mark the phases. Tooltips show their names.</p>\n";
  html += plot("Insertion", "[mm]",
               overTime(metrics, [&hand](const Sample& s, std::size_t k) { return 1e3 * hand(s, k).insertion; }));
  html += plot("Rotation of the handles", "[rad]",
               overTime(metrics, [&hand](const Sample& s, std::size_t k) { return hand(s, k).rotation; }));
  html += plot("Force at the handles, largest of every 50 ms", "[N]",
               overTime(metrics, [](const Sample& s, std::size_t k) { return s.peaks.hand_force[k]; }));
  PlotLine sum{"sum", colour(0), {}};
  PlotLine largest{"largest contact", colour(1), {}};
  bool inflated = false;
  for (const Sample& sample : metrics.samples())
  {
    sum.points.emplace_back(sample.observation.time, sample.peaks.wall.sum);
    largest.points.emplace_back(sample.observation.time, sample.peaks.wall.largest);
    for (const procedure::InstrumentView& view : sample.observation.instruments)
      inflated = inflated || view.hand.pressure != 0.0;
  }
  html += plot("Force on the wall, largest of every 50 ms", "[N]", {sum, largest});
  if (inflated)
    html += plot("Pressure at the inflator", "[atm]",
                 overTime(metrics, [&hand](const Sample& s, std::size_t k)
                          { return hand(s, k).pressure / units::kAtmosphere; }));
  return html;
}

/** Mean pressure of each beat at the inlet of the vessel, behind lesions, and at the instruments' pressure lines. */
std::string pressurePlot(const SessionMetrics& metrics)
{
  const PressureCourse course = metrics.pressure();
  if (course.empty())
    return "";
  SvgPlot svg;
  svg.title = "Mean pressure of each beat";
  svg.abscissa = "time [s]";
  svg.ordinate = "[mmHg]";
  svg.bands = phaseBands(metrics);
  const auto add = [&](const std::string& name, const auto& value)
  {
    PlotLine line{name, colour(svg.lines.size()), {}};
    for (std::size_t k = 0; k < course.times().size(); ++k)
      line.points.emplace_back(course.times()[k], value(course.beats()[k]) / units::kMillimetreOfMercury);
    svg.lines.push_back(std::move(line));
  };
  add("aorta", [](const flow::BeatMeans& beat) { return beat.root; });
  for (std::size_t k = 0; k < course.beats().front().lesions.size(); ++k)
    add("behind lesion " + std::to_string(k + 1), [k](const flow::BeatMeans& beat) { return beat.lesions[k]; });
  std::size_t next = 0;
  for (const scene::DrivenInstrument& driven : metrics.scene().instruments)
    if (instrument::pressureLineOf(driven.instrument))
    {
      add(driven.instrument.name, [next](const flow::BeatMeans& beat) { return beat.readings[next]; });
      ++next;
    }
  return svg.text();
}

/** Frontal map of the tip paths and the centreline of the vessel. */
std::string tipMap(const SessionMetrics& metrics)
{
  SvgPlot svg;
  svg.title = "Paths of the tips, frontal view";
  svg.abscissa = "x, towards the patient's left [mm]";
  svg.ordinate = "z, towards the head [mm]";
  svg.equal_scales = true;
  svg.height = 700.0;
  for (int b = 0; b < metrics.locator().branches(); ++b)
  {
    PlotLine line{"", "#cccccc", {}};
    for (const Eigen::Vector3d& point : metrics.locator().line(b).points())
      line.points.emplace_back(1e3 * point.x(), 1e3 * point.z());
    svg.lines.push_back(std::move(line));
  }
  for (std::size_t k = 0; k < metrics.scene().instruments.size(); ++k)
  {
    PlotLine line{metrics.scene().instruments[k].instrument.name, colour(k), {}};
    for (const Sample& sample : metrics.samples())
      if (sample.observation.instruments[k].hand.insertion > 0.0)
        line.points.emplace_back(1e3 * sample.observation.instruments[k].tip.x(),
                                 1e3 * sample.observation.instruments[k].tip.z());
    svg.lines.push_back(std::move(line));
  }
  return "<h2>Tip paths</h2>\n" + svg.text();
}

}  // namespace

std::string metricsPage(const SessionMetrics& metrics)
{
  const Json json = metrics.json();
  return kHead + summary(json) + lessonTable(metrics) + notesTables(metrics, json) + stepsTable(json) +
         instrumentsTable(json) + lesionsTable(json) + pressureTable(json) + errorTables(json) + faultsTable(json) +
         timePlots(metrics) + pressurePlot(metrics) + tipMap(metrics) + "</body></html>\n";
}

}  // namespace endovascular_sim::results
