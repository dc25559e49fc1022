#include "results/session_metrics.h"

#include <algorithm>
#include <cmath>

#include <nlohmann/json.hpp>

#include "results/lesson_mark.h"
#include "results/smoothness.h"
#include "results/wall_force_report.h"

namespace endovascular_sim::results
{
namespace
{

using Json = nlohmann::ordered_json;

constexpr double kEntryDepth = 3e-3;  // depth beyond an ostium that counts as an entry [m]
constexpr double kAhead = 2e-3;       // lead of a balloon catheter's tip over its wire that is an error [m]
constexpr double kMoving = 0.5e-3;    // speed above which a handle counts as moving [m/s]
constexpr double kSameTime = 1.0;     // interval within which a recurring force belongs to the same error [s]
constexpr double kRecovery = 0.1;     // time after a fault until forces count as those of the trainee [s]
constexpr double kTurning = 0.05;     // rotation speed above which a handle counts as moving [rad/s]

/** Allowed branches of each instrument: those on the path to any of its goals in the procedure. An instrument without a
 *  goal has no wrong branches. */
std::vector<std::vector<bool>> allowedBranches(const scene::Scene& scene, const procedure::BranchLocator& locator,
                                               int entered)
{
  std::vector<std::vector<bool>> allowed(scene.instruments.size());
  for (std::size_t k = 0; scene.procedure && k < allowed.size(); ++k)
    for (const scene::StepScene& step : scene.procedure->steps)
    {
      const bool exchange = step.action == scene::StepAction::kExchange;
      const std::string& moved = exchange ? step.replacement : step.instrument;
      const std::string& goal = step.until.tip_in.empty() ? step.until.balloon_in : step.until.tip_in;
      if (moved != scene.instruments[k].instrument.name || goal.empty() || locator.find(goal) < 0)
        continue;
      const std::vector<bool> way = locator.pathBetween(entered, locator.find(goal));
      allowed[k].resize(way.size(), false);
      for (std::size_t b = 0; b < way.size(); ++b)
        allowed[k][b] = allowed[k][b] || way[b];
    }
  for (std::vector<bool>& way : allowed)
    if (way.empty())
      way.assign(static_cast<std::size_t>(locator.branches()), true);
  return allowed;
}

const char* outcomeName(procedure::Progress progress)
{
  switch (progress)
  {
    case procedure::Progress::kDone:
      return "done";
    case procedure::Progress::kFailed:
      return "failed";
    case procedure::Progress::kSupportLost:
      return "lost its support";
    case procedure::Progress::kRunning:
      break;
  }
  return "not finished";
}

}  // namespace

SessionMetrics::SessionMetrics(const scene::Scene& scene, const vessel::CentrelineTree& tree,
                               const Eigen::Vector3d& entry)
  : scene_(scene),
    locator_(tree, scene.procedure ? scene.procedure->branches : std::vector<scene::NamedBranch>()),
    on_way_(allowedBranches(scene, locator_, locator_.at(entry).branch)),
    active_stay_(scene.instruments.size(), -1),
    ahead_(scene.instruments.size(), false),
    ahead_time_(scene.instruments.size(), 0.0),
    was_in_(scene.instruments.size(), false),
    entries_(scene.instruments.size(), 0)
{
}

void SessionMetrics::add(Sample sample)
{
  const double time = sample.observation.time;
  if (SessionSampler::intervalAt(time) == interval_)
    return;
  interval_ = SessionSampler::intervalAt(time);
  followFaults(sample);
  sampled_until_ = time;
  if (!sample.isFinite())
    return;
  procedure::locate(sample.observation, locator_);
  followBranches(sample);
  followWires(sample);
  followExchanges(sample);
  followForces(sample);
  samples_.push_back(std::move(sample));
  trusted_.push_back(time >= untrusted_until_);
}

void SessionMetrics::followFaults(const Sample& sample)
{
  const double time = sample.observation.time;
  if (sample.faults.rejected_steps > 0)
    addFault("rejected step", time, sample.faults.rejected_steps);
  if (sample.faults.stale_steps > 0)
    addFault("stale contact set", time, sample.faults.stale_steps);
  if (!sample.isFinite())
    addFault("non-finite value", time, 1);
}

/** Adds a fault since the previous sample, which continues a fault of the same kind until then. */
void SessionMetrics::addFault(const char* kind, double time, std::uint64_t steps)
{
  untrusted_until_ = time + kRecovery;
  const auto continues = [&](const SimulatorFault& fault) { return fault.kind == kind && fault.end == sampled_until_; };
  const auto fault = std::find_if(faults_.rbegin(), faults_.rend(), continues);
  if (fault == faults_.rend())
  {
    faults_.push_back({kind, sampled_until_, time, steps});
    return;
  }
  fault->end = time;
  fault->steps += steps;
}

void SessionMetrics::setSteps(std::vector<procedure::StepRecord> steps, std::string failure)
{
  steps_ = std::move(steps);
  failure_ = std::move(failure);
}

void SessionMetrics::addEvent(const std::string& kind, int instrument, double time)
{
  if (kind != "stent_placed")
    errors_.push_back({kind, instrument, time, 0.0, ""});
}

const std::string& SessionMetrics::nameOf(int instrument) const
{
  return scene_.instruments[static_cast<std::size_t>(instrument)].instrument.name;
}

void SessionMetrics::followBranches(const Sample& sample)
{
  for (std::size_t k = 0; k < active_stay_.size(); ++k)
  {
    const procedure::BranchPosition& position = sample.observation.instruments[k].branch_position;
    const bool wrong = !sample.observation.instruments[k].covered && position.branch >= 0 &&
                       !on_way_[k][static_cast<std::size_t>(position.branch)];
    int& now = active_stay_[k];
    if (now >= 0 && (!wrong || wrong_branches_[static_cast<std::size_t>(now)].branch != position.branch))
      now = -1;
    if (wrong && now < 0 && position.depth > kEntryDepth)
    {
      now = static_cast<int>(wrong_branches_.size());
      wrong_branches_.push_back(
          {static_cast<int>(k), position.branch, sample.observation.time, sample.observation.time, position.depth});
    }
    if (now < 0)
      continue;
    WrongBranch& stay = wrong_branches_[static_cast<std::size_t>(now)];
    stay.end = sample.observation.time;
    stay.deepest = std::max(stay.deepest, position.depth);
  }
}

/** Detects a balloon catheter that advances ahead of all guidewires. */
void SessionMetrics::followWires(const Sample& sample)
{
  double furthest = 0.0;
  for (std::size_t k = 0; k < ahead_.size(); ++k)
    if (scene_.instruments[k].instrument.kind == instrument::Kind::kGuidewire)
      furthest = std::max(furthest, sample.observation.instruments[k].hand.insertion);
  for (std::size_t k = 0; k < ahead_.size(); ++k)
  {
    const double lead = sample.observation.instruments[k].hand.insertion - furthest;
    const bool ahead = scene_.instruments[k].instrument.kind == instrument::Kind::kBalloonCatheter && lead > kAhead;
    if (ahead && !ahead_[k])
      errors_.push_back({"balloon ahead of its wire", static_cast<int>(k), sample.observation.time, lead, "m"});
    ahead_[k] = ahead;
    ahead_time_[k] += ahead ? 1.0 / kRate : 0.0;
  }
}

/** Counts exchanges: an instrument enters after another one has left. */
void SessionMetrics::followExchanges(const Sample& sample)
{
  for (std::size_t k = 0; k < was_in_.size(); ++k)
  {
    const bool is_in = sample.observation.instruments[k].hand.insertion > 0.0;
    if (is_in && !was_in_[k])
    {
      ++entries_[k];
      exchanges_ += withdrawn_ > 0;
      withdrawn_ = std::max(0, withdrawn_ - 1);
    }
    if (was_in_[k] && !is_in)
      ++withdrawn_;
    was_in_[k] = is_in;
  }
}

void SessionMetrics::followForces(const Sample& sample)
{
  const int foremost = foremostOf(sample.observation);
  if (sample.observation.time < untrusted_until_ || sample.at_tip <= kPerforation ||
      scene_.instruments[static_cast<std::size_t>(foremost)].instrument.kind != instrument::Kind::kGuidewire)
    return;
  if (sample.observation.time > perforation_until_ + kSameTime)
  {
    perforation_error_ = errors_.size();
    errors_.push_back({"risk of perforation", foremost, sample.observation.time, sample.at_tip, "N"});
  }
  errors_[perforation_error_].value = std::max(errors_[perforation_error_].value, sample.at_tip);
  perforation_until_ = sample.observation.time;
}

/** Time during which at least one handle moves or a balloon is under pressure [s]. Fluoroscopy is assumed to be on
 *  during this time. */
double SessionMetrics::activeTime() const
{
  double time = 0.0;
  for (std::size_t i = 1; i < samples_.size(); ++i)
  {
    const double dt = samples_[i].observation.time - samples_[i - 1].observation.time;
    bool moves = false;
    for (std::size_t k = 0; k < was_in_.size(); ++k)
    {
      const simulation::HandState& before = samples_[i - 1].observation.instruments[k].hand;
      const simulation::HandState& now = samples_[i].observation.instruments[k].hand;
      moves = moves || std::abs(now.insertion - before.insertion) > kMoving * dt ||
              std::abs(now.rotation - before.rotation) > kTurning * dt || now.pressure != 0.0;
    }
    time += moves ? dt : 0.0;
  }
  return time;
}

Json SessionMetrics::instrumentJson(std::size_t k) const
{
  double path = 0.0;
  double peak = 0.0;
  std::vector<double> speed;
  std::size_t last = 0;
  for (std::size_t i = 1; i < samples_.size(); ++i)
  {
    const procedure::InstrumentView& before = samples_[i - 1].observation.instruments[k];
    const procedure::InstrumentView& now = samples_[i].observation.instruments[k];
    const double travel = (now.tip - before.tip).norm();
    path += travel;
    if (trusted_[i])
      peak = std::max(peak, std::abs(now.hand.force));
    if (speed.empty() && travel < kMoving / kRate)
      continue;
    speed.push_back(travel * kRate);
    if (travel >= kMoving / kRate)
      last = speed.size();
  }
  speed.resize(last);
  int entries = 0;
  double wrong = 0.0;
  for (const WrongBranch& stay : wrong_branches_)
    if (stay.instrument == static_cast<int>(k))
    {
      ++entries;
      wrong += stay.end - stay.begin;
    }
  return {{"name", nameOf(static_cast<int>(k))},
          {"insertions", entries_[k]},
          {"tip_path", path},
          {"spectral_arc_length", spectralArcLength(speed, kRate)},
          {"wrong_branch_entries", entries},
          {"wrong_branch_time", wrong},
          {"time_ahead_of_wire", ahead_time_[k]},
          {"peak_hand_force", peak}};
}

/** Errors of the trainee in the order of their times. */
Json SessionMetrics::errorsJson() const
{
  std::vector<SessionError> errors = errors_;
  std::stable_sort(errors.begin(), errors.end(),
                   [](const SessionError& a, const SessionError& b) { return a.time < b.time; });
  Json json = Json::array();
  for (const SessionError& error : errors)
  {
    Json entry = {{"error", error.kind}, {"instrument", nameOf(error.instrument)}, {"time", error.time}};
    if (!error.unit.empty())
      entry["value"] = error.value;
    json.push_back(entry);
  }
  return json;
}

Json SessionMetrics::faultsJson() const
{
  Json json = Json::array();
  for (const SimulatorFault& fault : faults_)
    json.push_back({{"fault", fault.kind}, {"begin", fault.begin}, {"end", fault.end}, {"steps", fault.steps}});
  return json;
}

Json SessionMetrics::json() const
{
  Json json = {{"scene", scene_.name}};
  json["procedure"] = scene_.procedure ? Json(scene_.procedure->name) : Json(nullptr);
  if (!steps_.empty())
    json["outcome"] = outcomeName(steps_.back().outcome);
  json["failure"] = failure_.empty() ? Json(nullptr) : Json(failure_);
  json["procedure_time"] = samples_.empty() ? 0.0 : samples_.back().observation.time;
  json["fluoroscopy_time"] = scene_.fluoroscopy ? activeTime() : 0.0;
  json["instrument_exchanges"] = exchanges_;
  if (const std::vector<Mark> marks = lessonMarks(*this); !marks.empty())
    json["lesson"] = toJson(marks);
  json["steps"] = Json::array();
  for (const procedure::StepRecord& step : steps_)
    json["steps"].push_back({{"phase", step.phase},
                             {"step", step.name},
                             {"begin", step.begin},
                             {"end", step.end},
                             {"new_tries", step.retries},
                             {"wrong_branches", step.wrong_branches},
                             {"outcome", outcomeName(step.outcome)}});
  json["instruments"] = Json::array();
  for (std::size_t k = 0; k < was_in_.size(); ++k)
    json["instruments"].push_back(instrumentJson(k));
  json["wrong_branches"] = Json::array();
  for (const WrongBranch& stay : wrong_branches_)
    json["wrong_branches"].push_back({{"instrument", nameOf(stay.instrument)},
                                      {"branch", locator_.name(stay.branch)},
                                      {"begin", stay.begin},
                                      {"end", stay.end},
                                      {"deepest", stay.deepest}});
  json["wall_forces"] = wall_forces_ ? toJson(*wall_forces_, 0) : Json(nullptr);
  if (wall_forces_)
    json["wall_forces"].erase("triangles");
  json["lesions"] = toJson(lesions_);
  json["errors"] = errorsJson();
  json["simulator_faults"] = faultsJson();
  return json;
}

}  // namespace endovascular_sim::results
