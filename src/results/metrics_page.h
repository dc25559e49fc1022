#pragma once

#include <string>

#include "results/session_metrics.h"

namespace endovascular_sim::results
{

/** The metrics as one HTML page that needs no other file: tables, and plots as SVG. */
std::string metricsPage(const SessionMetrics& metrics);

}  // namespace endovascular_sim::results
