#include "results/metrics_files.h"

#include <array>
#include <cstdio>

#include <nlohmann/json.hpp>

#include "common/output_file.h"
#include "results/metrics_page.h"

namespace endovascular_sim::results
{

std::string instrumentsCsv(const SessionMetrics& metrics)
{
  std::string text =
      "time,instrument,insertion,rotation,pressure,hand_force,hand_torque,peak_hand_force,peak_hand_torque,tip_x,tip_y,"
      "tip_z,branch,depth,tip_rotation\n";
  std::array<char, 400> row{};
  for (const Sample& sample : metrics.samples())
    for (std::size_t k = 0; k < sample.observation.instruments.size(); ++k)
    {
      const procedure::InstrumentView& view = sample.observation.instruments[k];
      std::snprintf(row.data(), row.size(), "%.9g,%s,%.9g,%.9g,%.9g,%.9g,%.9g,%.9g,%.9g,%.9g,%.9g,%.9g,%s,%.9g,%.9g\n",
                    sample.observation.time, metrics.scene().instruments[k].instrument.name.c_str(),
                    view.hand.insertion, view.hand.rotation, view.hand.pressure, view.hand.force, view.hand.torque,
                    sample.peaks.hand_force[k], sample.peaks.hand_torque[k], view.tip.x(), view.tip.y(), view.tip.z(),
                    metrics.locator().name(view.branch_position.branch).c_str(), view.branch_position.depth,
                    view.tip_rotation);
      text += row.data();
    }
  return text;
}

void writeMetrics(const SessionMetrics& metrics, const std::string& folder)
{
  writeTextFile(folder + "/metrics.json", metrics.json().dump(2) + "\n");
  writeTextFile(folder + "/metrics.html", metricsPage(metrics));
  writeTextFile(folder + "/instruments.csv", instrumentsCsv(metrics));
}

}  // namespace endovascular_sim::results
