#include "benchmark/sheet/data_sheet.h"

#include <algorithm>
#include <cmath>

#include <nlohmann/json.hpp>

#include "benchmark/harness/table.h"
#include "common/text/format.h"
#include "common/units.h"

namespace endovascular_sim::benchmark
{
namespace
{

using Json = nlohmann::ordered_json;
using results::escaped;

constexpr int kDigits = 4;

constexpr auto kStyle = R"(
body { font-family: sans-serif; max-width: 960px; margin: 1.2em auto; color: #222; font-size: 13px; }
table { border-collapse: collapse; width: 100%; margin: 0.4em 0 1em; }
th, td { text-align: left; padding: 3px 10px 3px 0; border-bottom: 1px solid #ddd; vertical-align: top; }
th.n, td.n { text-align: right; white-space: nowrap; }
tr.test td { font-weight: bold; padding-top: 10px; border-bottom: 1px solid #999; }
tr.conditions td { color: #666; border-bottom: none; }
h1 { font-size: 21px; margin-bottom: 0.1em; } p { margin: 0.2em 0; }
.curves { display: grid; grid-template-columns: 1fr 1fr; gap: 6px; } .curves svg { width: 100%; height: auto; }
code { background: #f3f3f3; }
)";

std::string deviationText(const SheetRow& row)
{
  if (std::isnan(row.reference))
    return "";
  return row.by_difference ? formatted("%+.2g ", row.deviation()) + row.unit
                           : formatted("%+.2f %%", 100.0 * row.deviation());
}

std::string rowOf(const SheetRow& row)
{
  const std::string reference = std::isnan(row.reference) ? "" : shortNumber(row.reference, kDigits);
  std::string html = "<tr><td>" + escaped(row.quantity) + "</td>";
  for (const std::string& cell : {shortNumber(row.value, kDigits), reference})
    html += "<td class=\"n\">" + cell + "</td>";
  return html + "<td>" + escaped(row.unit) + "</td><td class=\"n\">" + escaped(deviationText(row)) + "</td><td>" +
         escaped(row.method) + "</td></tr>\n";
}

std::string tableOf(const DataSheet& sheet)
{
  std::string html =
      "<table><tr><th>quantity</th><th class=\"n\">value</th><th class=\"n\">reference</th><th>unit</th>"
      "<th class=\"n\">deviation</th><th>reference by</th></tr>\n";
  for (const BenchTest& test : sheet.tests)
  {
    html += "<tr class=\"test\"><td colspan=\"6\">" + escaped(test.heading) + "</td></tr>\n";
    html += "<tr class=\"conditions\"><td colspan=\"6\">" + escaped(test.conditions) + " Scene <code>" +
            escaped(test.name) + "</code>.</td></tr>\n";
    for (const SheetRow& row : test.rows)
      html += rowOf(row);
  }
  return html + "</table>\n";
}

}  // namespace

std::string outlineOf(const instrument::Instrument& instrument)
{
  const double diameter = 2.0 * crossingRadius(instrument);
  const double length = 1e3 * instrument.wire.length();
  if (instrument.kind == instrument::Kind::kGuidewire)
    return formatted("Guidewire, %.3f in, %.0f mm", diameter / units::kInch, length);
  return formatted("%s, %.1fF, lumen %.3f in, %.0f mm",
                   instrument.kind == instrument::Kind::kCatheter ? "Catheter" : "Balloon catheter",
                   diameter / units::kFrench, 2.0 * instrument.inner_radius / units::kInch, length);
}

std::string htmlOf(const DataSheet& sheet)
{
  std::string html = "<!DOCTYPE html>\n<html lang=\"en\"><head><meta charset=\"utf-8\"><title>" + escaped(sheet.title) +
                     "</title><style>" + kStyle + "</style></head><body>\n<h1>" + escaped(sheet.title) + "</h1>\n<p>" +
                     escaped(sheet.outline) + ". Bench tests by simulation: <code>" + escaped(sheet.command) +
                     "</code></p>\n" + tableOf(sheet) + "<div class=\"curves\">\n";
  for (const BenchTest& test : sheet.tests)
    for (results::SvgPlot plot : test.plots)
    {
      plot.width = 470.0;
      plot.height = 230.0;
      html += plot.text() + "\n";
    }
  return html + "</div>\n</body></html>\n";
}

std::string csvOf(const DataSheet& sheet)
{
  Table table({"test", "quantity", "value", "unit", "reference", "deviation", "method"});
  for (const BenchTest& test : sheet.tests)
    for (const SheetRow& row : test.rows)
      table.add({test.name, row.quantity, number(row.value, 9), row.unit, number(row.reference, 9),
                 number(row.deviation(), 4), row.method});
  return table.csv();
}

std::string jsonOf(const DataSheet& sheet)
{
  Json json;
  json["instrument"] = sheet.title;
  json["outline"] = sheet.outline;
  json["command"] = sheet.command;
  for (const BenchTest& test : sheet.tests)
  {
    Json of_test = {{"scene", test.name}, {"test", test.heading}, {"conditions", test.conditions}};
    for (const SheetRow& row : test.rows)
      of_test["rows"].push_back({{"quantity", row.quantity},
                                 {"value", row.value},
                                 {"unit", row.unit},
                                 {"reference", row.reference},
                                 {"deviation", row.deviation()},
                                 {"method", row.method}});
    json["tests"].push_back(of_test);
  }
  return json.dump(2) + "\n";
}

}  // namespace endovascular_sim::benchmark
