#pragma once

#include <string>

#include "results/session_metrics.h"

namespace endovascular_sim::results
{

/** Text of instruments.csv: one row per sample and instrument, SI units. */
std::string instrumentsCsv(const SessionMetrics& metrics);

/** Writes metrics.json, metrics.html and instruments.csv.
 *  @throws InputError if a file cannot be written */
void writeMetrics(const SessionMetrics& metrics, const std::string& folder);

}  // namespace endovascular_sim::results
