#include "results/lesson_mark.h"

#include <algorithm>
#include <cmath>
#include <fstream>

#include <nlohmann/json.hpp>

#include "common/error.h"
#include "common/text/format.h"

namespace endovascular_sim::results
{
namespace
{

const char* const kMissingSteps = "steps not done";

std::string text(double value, const std::string& unit)
{
  const std::string number = formatted(unit == "N" ? "%.2f" : unit.empty() ? "%.0f" : "%.1f", value);
  return unit.empty() ? number : number + " " + unit;
}

double largestHandForce(const SessionMetrics& metrics)
{
  double largest = 0.0;
  for (std::size_t k = 0; k < metrics.scene().instruments.size(); ++k)
    largest = std::max(largest, metrics.peakHandForce(k));
  return largest;
}

double largestStenosis(const SessionMetrics& metrics)
{
  double largest = 0.0;
  for (const LesionOutcome& lesion : metrics.lesions())
    largest = std::max(largest, lesion.after.stenosis);
  return largest;
}

/** Steps of the procedure that are not done, an exchange counted as two. */
double missingSteps(const SessionMetrics& metrics)
{
  const std::size_t all = procedure::expandedSteps(*metrics.scene().procedure).size();
  std::size_t done = 0;
  for (const procedure::StepRecord& record : metrics.steps())
    done += record.outcome == procedure::Progress::kDone ? 1 : 0;
  return static_cast<double>(all - std::min(all, done));
}

/** Time of the last sample at which all instruments still rest as in the first one [s]; 0 without samples. */
double firstMotion(const SessionMetrics& metrics)
{
  constexpr double kSlide = 1e-4;  // smallest motion that counts [m]
  constexpr double kTurn = 0.02;   // [rad]
  const std::vector<Sample>& samples = metrics.samples();
  double rest = 0.0;
  for (const Sample& sample : samples)
  {
    for (std::size_t k = 0; k < sample.observation.instruments.size(); ++k)
    {
      const simulation::HandState& hand = sample.observation.instruments[k].hand;
      const simulation::HandState& first = samples.front().observation.instruments[k].hand;
      if (std::abs(hand.insertion - first.insertion) > kSlide || std::abs(hand.rotation - first.rotation) > kTurn)
        return rest;
    }
    rest = sample.observation.time;
  }
  return rest;
}

/** Time from the first motion to the end of the last step [s]: reading before the start does not count. */
double lessonTime(const SessionMetrics& metrics)
{
  return metrics.steps().empty() ? 0.0 : std::max(0.0, metrics.steps().back().end - firstMotion(metrics));
}

}  // namespace

std::vector<Mark> lessonMarks(const SessionMetrics& metrics)
{
  std::vector<Mark> marks;
  if (!metrics.scene().procedure)
    return marks;
  const auto add = [&marks](const std::string& name, double value, double limit, const std::string& unit)
  {
    if (!std::isnan(limit))
      marks.push_back({name, value, limit, unit, value <= limit});
  };
  const scene::PassMarks& pass = metrics.scene().procedure->pass;
  add("time from the first motion", lessonTime(metrics), pass.time, "s");
  add("largest force on the wall", metrics.wallForces() ? metrics.wallForces()->whole.peak : 0.0, pass.wall_force, "N");
  add("largest force on a handle", largestHandForce(metrics), pass.hand_force, "N");
  add("wrong branches", static_cast<double>(metrics.wrongBranches().size()), pass.wrong_branches, "");
  add("errors", static_cast<double>(metrics.errors().size()), pass.errors, "");
  add("remaining stenosis", 100.0 * largestStenosis(metrics), 100.0 * pass.stenosis, "%");
  if (!marks.empty())
  {
    const double missing = missingSteps(metrics);
    marks.insert(marks.begin(), {kMissingSteps, missing, 0.0, "", missing == 0.0});
  }
  return marks;
}

std::vector<Mark> marksOfFile(const std::string& file)
{
  std::ifstream stream(file);
  if (!stream)
    throw InputError(file, "", "cannot be read; give the metrics.json of a session");
  const auto json = nlohmann::json::parse(stream, nullptr, false);
  std::vector<Mark> marks;
  try
  {
    if (json.is_discarded())
      throw InputError(file, "", "is no JSON; give the metrics.json of a session");
    if (!json.contains("lesson") || json["lesson"].is_null())
      return marks;
    for (const auto& mark : json["lesson"].at("marks"))
      marks.push_back({mark.at("mark"), mark.at("value"), mark.at("limit"), mark.at("unit"), mark.at("passed")});
  }
  catch (const nlohmann::json::exception& error)
  {
    throw InputError(file, "lesson", std::string("is not that of a metrics.json (") + error.what() + ")");
  }
  return marks;
}

std::size_t stepsBefore(const SessionMetrics& metrics)
{
  if (metrics.samples().empty())
    return 0;
  const double begin = metrics.samples().front().observation.time;
  const auto isBefore = [begin](const procedure::StepRecord& record)
  { return record.outcome == procedure::Progress::kDone && record.end < begin; };
  return static_cast<std::size_t>(std::count_if(metrics.steps().begin(), metrics.steps().end(), isBefore));
}

nlohmann::ordered_json toJson(const std::vector<Mark>& marks, std::size_t steps_before)
{
  using Json = nlohmann::ordered_json;
  if (marks.empty())
    return nullptr;
  Json json = {{"from_step", steps_before + 1},
               {"passed", std::all_of(marks.begin(), marks.end(), [](const Mark& mark) { return mark.passed; })}};
  json["marks"] = Json::array();
  for (const Mark& mark : marks)
    json["marks"].push_back({{"mark", mark.name},
                             {"value", mark.value},
                             {"limit", mark.limit},
                             {"unit", mark.unit},
                             {"passed", mark.passed}});
  return json;
}

std::string verdict(const std::vector<Mark>& marks, std::size_t steps_before)
{
  if (marks.empty())
    return "";
  std::string failures;
  for (const Mark& mark : marks)
  {
    if (mark.passed)
      continue;
    failures += failures.empty() ? " " : "; ";
    if (mark.name == kMissingSteps)
      failures += text(mark.value, mark.unit) + " " + mark.name;
    else
      failures += mark.name + " " + text(mark.value, mark.unit) + ", at most " + text(mark.limit, mark.unit);
  }
  const std::string part = steps_before == 0 ? "" : " from step " + std::to_string(steps_before + 1) + " on";
  return failures.empty() ? "lesson passed" + part : "lesson not passed" + part + ":" + failures;
}

}  // namespace endovascular_sim::results
