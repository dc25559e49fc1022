#pragma once

#include <string>

#include "results/session_metrics.h"

namespace endovascular_sim::results
{

/** Metrics as a self-contained HTML page with tables and SVG plots. */
std::string metricsPage(const SessionMetrics& metrics);

}  // namespace endovascular_sim::results
