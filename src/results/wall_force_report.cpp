#include "results/wall_force_report.h"

#include <algorithm>

#include <nlohmann/json.hpp>

#include "common/text/format.h"

namespace endovascular_sim::results
{
namespace
{

using Json = nlohmann::ordered_json;

Json nameOrNull(const std::string& name)
{
  return name.empty() ? Json(nullptr) : Json(name);
}

Json toJson(const WallForceTotals& totals)
{
  const Eigen::Vector3d& position = totals.peak_position;
  return {
      {"peak", totals.peak},
      {"peak_position", totals.peak > 0.0 ? Json::array({position.x(), position.y(), position.z()}) : Json(nullptr)},
      {"peak_time", totals.peak_time},
      {"peak_sum", totals.peak_sum},
      {"peak_sum_time", totals.peak_sum_time},
      {"integral", totals.integral},
      {"time_over_threshold", totals.time_over_threshold}};
}

/** Field of a CSV row, quoted if it contains a comma, a quote or a line break. */
std::string csvText(const std::string& text)
{
  if (text.find_first_of(",\"\n") == std::string::npos)
    return text;
  std::string quoted = "\"";
  for (const char c : text)
    quoted += c == '"' ? std::string("\"\"") : std::string(1, c);
  return quoted + "\"";
}

std::string numbers(const std::vector<double>& values)
{
  std::string text;
  for (const double value : values)
    text += (text.empty() ? "" : ",") + shortNumber(value, 9);
  return text;
}

}  // namespace

Json toJson(const WallForceSummary& summary, std::size_t triangles)
{
  Json json = {{"threshold", summary.threshold}, {"time", summary.time}, {"triangles", triangles}};
  json.update(toJson(summary.whole));
  Json regions = Json::array();
  for (const WallForceTotals& totals : summary.regions)
  {
    Json region = {{"region", nameOrNull(totals.name)}};
    region.update(toJson(totals));
    regions.push_back(region);
    if (totals.region == summary.whole.peak_region)
      json["peak_region"] = region["region"];
  }
  json["by_region"] = regions;
  return json;
}

std::string wallForcesCsv(std::vector<WallForceRow> rows)
{
  std::sort(rows.begin(), rows.end(),
            [](const WallForceRow& a, const WallForceRow& b) { return a.force.triangle < b.force.triangle; });
  std::string text = "triangle,x,y,z,region,peak,peak_time,integral,time_over_threshold\n";
  for (const WallForceRow& row : rows)
    text += std::to_string(row.force.triangle) + "," + numbers({row.centre.x(), row.centre.y(), row.centre.z()}) + "," +
            csvText(row.region) + "," +
            numbers({row.force.peak, row.force.peak_time, row.force.integral, row.force.time_over_threshold}) + "\n";
  return text;
}

std::string vesselPointsCsv(const std::vector<Eigen::Vector3d>& vertices, std::size_t limit)
{
  const std::size_t every = std::max<std::size_t>(1, (vertices.size() + limit - 1) / limit);
  std::string text = "x,y,z\n";
  for (std::size_t v = 0; v < vertices.size(); v += every)
    text += numbers({vertices[v].x(), vertices[v].y(), vertices[v].z()}) + "\n";
  return text;
}

}  // namespace endovascular_sim::results
