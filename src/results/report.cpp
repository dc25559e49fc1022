#include "results/report.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <utility>

#include <nlohmann/json.hpp>

#include "common/hash.h"
#include "results/wall_force_report.h"

namespace endovascular_sim::results
{

namespace
{

using Json = nlohmann::ordered_json;

// Node and keys of the step counters in /diagnostics.
constexpr auto kLoopNode = "rod_dynamics";
constexpr auto kStepsKey = "steps";
constexpr auto kMissesKey = "deadline misses";

/** Value of the largest magnitude; 0 without values. */
double ofLargestMagnitude(const std::vector<double>& values)
{
  const auto smaller = [](double a, double b) { return std::abs(a) < std::abs(b); };
  const auto largest = std::max_element(values.begin(), values.end(), smaller);
  return largest == values.end() ? 0.0 : *largest;
}

/** Number, or null if it is unknown or not finite; JSON has no NaN. */
Json numberOrNull(std::optional<double> value)
{
  return value && std::isfinite(*value) ? Json(*value) : Json(nullptr);
}

Json summary(const RunningValue& value)
{
  return {{"max", value.max()}, {"mean", value.mean()}, {"final", value.final()}};
}

Json vectorOf(const Eigen::Vector3d& vector)
{
  return Json::array({vector.x(), vector.y(), vector.z()});
}

/** Converts text to a JSON number if it is a finite number, otherwise to a JSON string. */
Json valueOf(const std::string& text)
{
  char* end = nullptr;
  const double number = std::strtod(text.c_str(), &end);
  const bool is_number = !text.empty() && *end == '\0' && std::isfinite(number);
  return is_number ? Json(number) : Json(text);
}

Json toJson(const RecordingOutcome& recording)
{
  return {{"file", recording.file},         {"bytes", recording.bytes},
          {"messages", recording.messages}, {"dropped", recording.dropped},
          {"previous", recording.previous}, {"error", recording.error.empty() ? Json(nullptr) : Json(recording.error)}};
}

Json toJson(const std::map<std::string, std::map<std::string, std::string>>& diagnostics)
{
  Json json = Json::object();
  for (const auto& [node, values] : diagnostics)
    for (const auto& [key, value] : values)
      json[node][key] = valueOf(value);
  return json;
}

}  // namespace

void RunningValue::add(double value)
{
  if (!std::isfinite(value))
    return;
  ++count_;
  sum_ += std::abs(value);
  max_ = std::max(max_, std::abs(value));
  final_ = value;
}

double RunningValue::mean() const
{
  return count_ > 0 ? sum_ / static_cast<double>(count_) : 0.0;
}

SessionReport::SessionReport(SessionIdentity identity) : identity_(std::move(identity)) {}

void SessionReport::addStep(std::uint64_t step, double wall_time, bool stale, std::uint64_t state_hash)
{
  if (steps_ == 0)
  {
    first_step_ = step;
    first_wall_time_ = wall_time;
    missed_steps_ = step - std::min(step, expected_first_);
  }
  else if (step <= last_step_)
  {
    ++repeated_steps_;
    return;
  }
  else
  {
    missed_steps_ += step - last_step_ - 1;
    longest_pause_ = std::max(longest_pause_, wall_time - last_wall_time_);
  }
  ++steps_;
  last_step_ = step;
  last_wall_time_ = wall_time;
  last_state_hash_ = state_hash;
  stale_steps_ += stale ? 1 : 0;
}

void SessionReport::setWallTimes(double wall_time, double longest_pause)
{
  first_wall_time_ = 0.0;
  last_wall_time_ = wall_time;
  longest_pause_ = longest_pause;
}

void SessionReport::addHands(const std::vector<double>& forces, const std::vector<double>& torques)
{
  hand_force_.add(ofLargestMagnitude(forces));
  hand_torque_.add(ofLargestMagnitude(torques));
}

void SessionReport::addTip(const Eigen::Vector3d& tip, double inserted_length, std::size_t nodes)
{
  if (!tip.allFinite())
    return;
  tip_ = tip;
  nodes_ = nodes;
  inserted_length_.add(inserted_length);
}

void SessionReport::setWallForces(WallForceSummary summary, std::size_t triangles)
{
  wall_forces_ = std::move(summary);
  touched_triangles_ = triangles;
}

void SessionReport::addDiagnostic(const std::string& node, const std::string& key, const std::string& value)
{
  diagnostics_[node][key] = value;
}

double SessionReport::simulatedTime() const
{
  return steps_ > 0 ? static_cast<double>(last_step_ + 1) * identity_.time_step : 0.0;
}

double SessionReport::wallTime() const
{
  return last_wall_time_ - first_wall_time_;
}

std::optional<double> SessionReport::realTimeFactor() const
{
  if (steps_ < 2 || wallTime() <= 0.0)
    return std::nullopt;
  return static_cast<double>(last_step_ - first_step_) * identity_.time_step / wallTime();
}

std::optional<double> SessionReport::diagnosticNumber(const std::string& node, const std::string& key) const
{
  const auto values = diagnostics_.find(node);
  if (values == diagnostics_.end())
    return std::nullopt;
  const auto entry = values->second.find(key);
  if (entry == values->second.end())
    return std::nullopt;
  const Json value = valueOf(entry->second);
  return value.is_number() ? std::optional<double>(value.get<double>()) : std::nullopt;
}

std::string SessionReport::json(const RecordingOutcome& recording, const std::string& error) const
{
  // Both counters come from the same diagnostics message. Diagnostics arrive once per second, so the steps counted here
  // would not match the misses.
  const std::optional<double> misses = diagnosticNumber(kLoopNode, kMissesKey);
  const std::optional<double> counted = diagnosticNumber(kLoopNode, kStepsKey);
  std::optional<double> on_time;
  if (misses && counted && *counted > 0.0)
    on_time = 100.0 * std::max(0.0, 1.0 - *misses / *counted);

  Json report;
  report["scene"] = {{"name", identity_.scene_name},
                     {"file", identity_.scene_file},
                     {"hash", Hash64::toHex(identity_.scene_hash)},
                     {"mesh_hash", Hash64::toHex(identity_.mesh_hash)},
                     {"seed", identity_.seed},
                     {"dt", identity_.time_step},
                     {"duration", identity_.duration}};
  report["software_version"] = identity_.software_version;
  report["commit"] = identity_.commit;
  report["physics"] = identity_.physics;
  report["subject"] = subject_.empty() ? Json(nullptr) : Json(subject_);
  report["error"] = error.empty() ? Json(nullptr) : Json(error);
  report["steps"] = steps_;
  report["steps_missing_from_recording"] = missed_steps_;
  report["gaps"] = toJson(notes_.gaps);
  report["marks"] = toJson(notes_.remarks);
  report["steps_repeated"] = repeated_steps_;
  report["simulated_time"] = simulatedTime();
  report["wall_time"] = wallTime();
  report["real_time_factor"] = numberOrNull(realTimeFactor());
  report["deadline_misses"] = numberOrNull(misses);
  report["on_time_percent"] = numberOrNull(on_time);
  report["longest_pause_between_steps"] = longest_pause_;
  report["steps_with_stale_contacts"] = stale_steps_;
  report["last_state_hash"] = Hash64::toHex(last_state_hash_);
  report["hand_force"] = summary(hand_force_);
  report["hand_torque"] = summary(hand_torque_);
  report["wall_forces"] = wall_forces_ ? toJson(*wall_forces_, touched_triangles_) : Json(nullptr);
  report["inserted_length"] = inserted_length_.final();
  report["tip_position"] = tip_ ? vectorOf(*tip_) : Json(nullptr);
  report["nodes"] = nodes_;
  report["vessel_box"] = vessel_box_.isEmpty()
                             ? Json(nullptr)
                             : Json{{"min", vectorOf(vessel_box_.min())}, {"max", vectorOf(vessel_box_.max())}};
  report["fluoroscopy"] = {{"frames", fluoroscopy_frames_}, {"pictures", fluoroscopy_pictures_}};
  report["recording"] = toJson(recording);
  report["diagnostics"] = toJson(diagnostics_);
  // Text from other processes may not be valid UTF-8. Invalid bytes are replaced, so that the report is always written.
  return report.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

}  // namespace endovascular_sim::results
