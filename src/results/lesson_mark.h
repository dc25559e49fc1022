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

/** Marks as JSON: {"passed": all of them, "marks": [...]}; null without marks. */
nlohmann::ordered_json toJson(const std::vector<Mark>& marks);

/** Verdict in one line, e.g. "not passed: procedure time 95.0 s, at most 90.0 s". Empty without marks. */
std::string verdict(const std::vector<Mark>& marks);

}  // namespace endovascular_sim::results
