#pragma once

#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "results/session_metrics.h"
#include "scene/model/scene_procedure.h"

namespace endovascular_sim::results
{

/** One criterion of a lesson. */
struct Mark
{
  std::string name;    ///< e.g. "procedure time"
  double value = 0.0;  ///< of the session
  double limit = 0.0;  ///< largest value that passes
  std::string unit;
  bool passed = false;
};

/** Marks of a session by the pass marks of its procedure: first whether all steps are done, then the limits in the
 * order of scene::PassMarks.
 *  @return empty without pass marks */
std::vector<Mark> lessonMarks(const SessionMetrics& metrics);

/** Marks in a metrics.json, without their limits where it has none; empty without marks.
 *  @throws InputError when the file cannot be read or is no metrics.json */
std::vector<Mark> marksOfFile(const std::string& file);

/** Number of steps that were done before the recording, which then begins with a saved state [1]. */
std::size_t stepsBefore(const SessionMetrics& metrics);

/** Marks as JSON: {"from_step": first recorded one, "passed": all marks, "marks": [...]}; null without marks.
 *  @param steps_before see stepsBefore() */
nlohmann::ordered_json toJson(const std::vector<Mark>& marks, std::size_t steps_before);

/** Verdict in one line, e.g. "lesson not passed: wrong branches 3, at most 2" or "lesson passed from step 6 on". Empty
 * without marks.
 *  @param steps_before see stepsBefore() */
std::string verdict(const std::vector<Mark>& marks, std::size_t steps_before);

}  // namespace endovascular_sim::results
