#pragma once

#include <vector>

#include "benchmark/harness/study.h"

namespace endovascular_sim::benchmark
{

/** Torque and force of a soft J tip that is turned steadily in a straight tube, after the tip has turned once. */
struct JTipTorque
{
  double mean_torque = 0.0;       ///< [N·m]
  double torque_deviation = 0.0;  ///< standard deviation [N·m]
  double force_deviation = 0.0;   ///< standard deviation of the hand force [N]
};

/** Turns a soft J tip of 3 mm in a straight tube of 6 mm.
 *  @param turns full turns that are averaged
 *  @param time_step [s] */
JTipTorque turnJTip(int facets_around, bool smooth, double friction, double turns, double time_step);

/** Tables of facetsStudy(). */
std::vector<TableSpec> facetsTables();

/** Torque of a J tip and noise of the hand force over the number of facets around the lumen. */
std::vector<Section> facetsStudy(const StudyOptions& options, const Progress& progress);

}  // namespace endovascular_sim::benchmark
