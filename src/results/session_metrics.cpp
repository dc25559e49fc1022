#include "results/session_metrics.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>

#include <nlohmann/json.hpp>

#include "results/lesson_mark.h"
#include "results/smoothness.h"
#include "results/wall_force_report.h"

namespace endovascular_sim::results
{
namespace
{

using Json = nlohmann::ordered_json;

constexpr double kAhead = 2e-3;     // lead of a balloon catheter's tip over its wire that is an error [m]
constexpr double kMoving = 0.5e-3;  // speed above which a handle counts as moving [m/s]
constexpr double kSameTime = 1.0;   // interval within which a recurring force belongs to the same error [s]
constexpr double kRecovery = 0.1;   // time after a fault until forces count as those of the trainee [s]
constexpr double kTurning = 0.05;   // rotation speed above which a handle counts as moving [rad/s]

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

bool isError(const std::string& event)
{
  return event != "stent_placed";
}

SessionMetrics::SessionMetrics(const scene::Scene& scene, const vessel::CentrelineTree& tree,
                               const Eigen::Vector3d& entry)
  : scene_(scene),
    locator_(tree, scene.procedure ? scene.procedure->branches : std::vector<scene::NamedBranch>()),
    branch_entries_(scene, locator_, locator_.at(entry).branch),
    limits_(scene.errors.value_or(scene::ErrorLimits())),
    support_watch_(scene, locator_, locator_.at(entry).branch),
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
  sample.peaks.hand_force.resize(was_in_.size(), 0.0);
  sample.peaks.hand_torque.resize(was_in_.size(), 0.0);
  procedure::locate(sample.observation, locator_);
  followWires(sample);
  followExchanges(sample);
  followForces(sample);
  followSupport(sample);
  samples_.push_back(std::move(sample));
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

void SessionMetrics::addTail(const Peaks& peaks)
{
  const bool is_over = !steps_.empty() && steps_.back().outcome != procedure::Progress::kRunning;
  if (!is_over && !samples_.empty())
    samples_.back().peaks.addHands(peaks.hand_force, peaks.hand_torque);
}

void SessionMetrics::setSteps(std::vector<procedure::StepRecord> steps, std::string failure)
{
  steps_ = std::move(steps);
  failure_ = std::move(failure);
}

void SessionMetrics::addEvent(const std::string& kind, int instrument, double time)
{
  if (isError(kind))
    errors_.push_back({kind, instrument, time, 0.0, ""});
}

const std::string& SessionMetrics::nameOf(int instrument) const
{
  return scene_.instruments[static_cast<std::size_t>(instrument)].instrument.name;
}

/** Index of the procedure's step at a time, an exchange counted as two; −1: none. */
int SessionMetrics::stepAt(double time) const
{
  const auto later = [](double t, const procedure::StepRecord& step) { return t < step.begin; };
  const auto next = std::upper_bound(steps_.begin(), steps_.end(), time, later);
  return next == steps_.begin() ? -1 : static_cast<int>(std::prev(next)->step);
}

std::vector<WrongBranch> SessionMetrics::wrongBranches() const
{
  std::vector<WrongBranch> stays;
  std::vector<int> active(was_in_.size(), -1);
  procedure::BranchEntries entries = branch_entries_;
  const bool is_over = !steps_.empty() && steps_.back().outcome != procedure::Progress::kRunning;
  for (const Sample& sample : samples_)
  {
    const double time = sample.observation.time;
    if (is_over && time > steps_.back().end)
      break;
    entries.add(sample.observation, stepAt(time));
    for (std::size_t k = 0; k < active.size(); ++k)
    {
      const auto instrument = static_cast<int>(k);
      const procedure::BranchPosition& position = sample.observation.instruments[k].branch_position;
      if (entries.enters(instrument))
      {
        active[k] = static_cast<int>(stays.size());
        stays.push_back({instrument, position.branch, time, time, position.depth});
      }
      if (!entries.isInside(instrument))
        continue;
      WrongBranch& stay = stays[static_cast<std::size_t>(active[k])];
      stay.end = time;
      stay.deepest = std::max(stay.deepest, position.depth);
    }
  }
  return stays;
}

double SessionMetrics::peakHandForce(std::size_t instrument) const
{
  double peak = 0.0;
  for (const Sample& sample : samples_)
    peak = std::max(peak, std::abs(sample.peaks.hand_force[instrument]));
  return peak;
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
  if (sample.observation.time < untrusted_until_)
  {
    pushing_ = -1;  // a push across a fault is not one push
    push_error_ = -1;
    return;
  }
  const int foremost = foremostOf(sample.observation);
  followPerforation(sample, foremost);
  followTipForce(sample, foremost);
}

void SessionMetrics::followPerforation(const Sample& sample, int foremost)
{
  const double at_tip = sample.peaks.wall.at_tip;
  if (at_tip <= limits_.perforation_force ||
      scene_.instruments[static_cast<std::size_t>(foremost)].instrument.kind != instrument::Kind::kGuidewire)
    return;
  if (sample.observation.time > perforation_until_ + kSameTime)
  {
    perforation_error_ = errors_.size();
    errors_.push_back({"risk of perforation", foremost, sample.observation.time, at_tip, "N"});
  }
  errors_[perforation_error_].value = std::max(errors_[perforation_error_].value, at_tip);
  perforation_until_ = sample.observation.time;
}

/** True where the hands push the instruments as a whole: a curve that presses on the wall by its shape, at rest or
 * while it is withdrawn, pushes them out. */
bool isPushed(const procedure::Observation& observation)
{
  double force = 0.0;
  for (const procedure::InstrumentView& view : observation.instruments)
    force += view.hand.force;
  return force > 0.0;
}

/** Detects a tip that is pushed on against the wall: the largest force of every interval between two samples exceeds
 *  the limit for longer than its time. The blunt tips of catheters may bear the force that risks a perforation by a
 *  wire. */
void SessionMetrics::followTipForce(const Sample& sample, int foremost)
{
  const double at_tip = sample.peaks.wall.at_tip;
  const bool is_wire =
      scene_.instruments[static_cast<std::size_t>(foremost)].instrument.kind == instrument::Kind::kGuidewire;
  const bool pushes =
      at_tip > (is_wire ? limits_.tip_force : limits_.perforation_force) && isPushed(sample.observation);
  if (!pushes || foremost != pushing_)
  {
    pushing_ = pushes ? foremost : -1;
    pushing_since_ = sample.observation.time;
    push_ = 0.0;
    push_error_ = -1;
  }
  push_ = std::max(push_, at_tip);
  if (pushes && push_error_ < 0 && sample.observation.time - pushing_since_ >= limits_.tip_force_time)
  {
    push_error_ = static_cast<std::ptrdiff_t>(errors_.size());
    errors_.push_back({"sustained force of a tip", foremost, pushing_since_, push_, "N"});
  }
  if (push_error_ >= 0)
    errors_[static_cast<std::size_t>(push_error_)].value = push_;
}

void SessionMetrics::followSupport(const Sample& sample)
{
  for (const int catheter : support_watch_.add(sample.observation))
    errors_.push_back({"support lost", catheter, sample.observation.time, 0.0, ""});
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

Json SessionMetrics::instrumentJson(std::size_t k, const std::vector<WrongBranch>& stays) const
{
  double path = 0.0;
  std::vector<double> speed;
  std::size_t last = 0;
  for (std::size_t i = 1; i < samples_.size(); ++i)
  {
    const procedure::InstrumentView& before = samples_[i - 1].observation.instruments[k];
    const procedure::InstrumentView& now = samples_[i].observation.instruments[k];
    const double travel = (now.tip - before.tip).norm();
    path += travel;
    if (speed.empty() && travel < kMoving / kRate)
      continue;
    speed.push_back(travel * kRate);
    if (travel >= kMoving / kRate)
      last = speed.size();
  }
  speed.resize(last);
  int entries = 0;
  double wrong = 0.0;
  for (const WrongBranch& stay : stays)
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
          {"peak_hand_force", peakHandForce(k)}};
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

/** Steps with the stays in wrong branches that begin during each. */
Json SessionMetrics::stepsJson(const std::vector<WrongBranch>& stays) const
{
  Json json = Json::array();
  for (std::size_t k = 0; k < steps_.size(); ++k)
  {
    const procedure::StepRecord& step = steps_[k];
    const double next = k + 1 < steps_.size() ? steps_[k + 1].begin : std::numeric_limits<double>::infinity();
    const auto wrong =
        std::count_if(stays.begin(), stays.end(),
                      [&](const WrongBranch& stay) { return stay.begin >= step.begin && stay.begin < next; });
    json.push_back({{"phase", step.phase},
                    {"step", step.name},
                    {"begin", step.begin},
                    {"end", step.end},
                    {"retries", step.retries},
                    {"wrong_branches", wrong},
                    {"outcome", outcomeName(step.outcome)}});
  }
  return json;
}

void SessionMetrics::addBeat(const flow::BeatMeans& means)
{
  // The result of a step of the flow acts one such step later.
  pressure_.add(static_cast<double>(means.step + 1) * scene_.flow->time_step, means);
}

PressureCourse SessionMetrics::pressure() const
{
  return pressure_.until(samples_.empty() ? 0.0 : samples_.back().observation.time);
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
    json["lesson"] = toJson(marks, stepsBefore(*this));
  const std::vector<WrongBranch> stays = wrongBranches();
  json["steps"] = stepsJson(stays);
  json["instruments"] = Json::array();
  for (std::size_t k = 0; k < was_in_.size(); ++k)
    json["instruments"].push_back(instrumentJson(k, stays));
  json["wrong_branches"] = Json::array();
  for (const WrongBranch& stay : stays)
    json["wrong_branches"].push_back({{"instrument", nameOf(stay.instrument)},
                                      {"branch", locator_.name(stay.branch)},
                                      {"begin", stay.begin},
                                      {"end", stay.end},
                                      {"deepest", stay.deepest}});
  json["wall_forces"] = wall_forces_ ? toJson(*wall_forces_, 0) : Json(nullptr);
  if (wall_forces_)
    json["wall_forces"].erase("triangles");
  json["lesions"] = toJson(lesions_);
  if (const PressureCourse course = pressure(); !course.empty())
    json["pressure"] = course.json(scene_);
  if (contrast_)
    json["contrast"] = toJson(*contrast_);
  json["errors"] = errorsJson();
  json["simulator_faults"] = faultsJson();
  if (!notes_.remarks.empty())
    json["marks"] = toJson(notes_.remarks);
  if (!notes_.gaps.empty())
    json["gaps"] = toJson(notes_.gaps);
  return json;
}

}  // namespace endovascular_sim::results
