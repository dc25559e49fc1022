#include "results/session_metrics.h"

#include <algorithm>
#include <cmath>

#include <nlohmann/json.hpp>

#include "results/smoothness.h"
#include "results/wall_force_report.h"

namespace endovascular_sim::results
{
namespace
{

using Json = nlohmann::ordered_json;

constexpr double kNoticed = 3e-3;   // m beyond an ostium that count as an entry
constexpr double kAhead = 2e-3;     // m by which a balloon catheter's tip is ahead of its wire's
constexpr double kMoving = 0.5e-3;  // m/s
constexpr double kSameTime = 1.0;   // s within which a force that returns is still the same mishap
constexpr double kTurning = 0.05;   // rad/s

/** For every instrument, the branches on the way to any goal that the procedure sets it. An instrument without a goal,
 *  and every one without a procedure, may be anywhere. */
std::vector<std::vector<bool>> waysOf(const scene::Scene& scene, const procedure::BranchLocator& locator, int entered)
{
  std::vector<std::vector<bool>> ways(scene.instruments.size());
  for (std::size_t k = 0; scene.procedure && k < ways.size(); ++k)
    for (const scene::StepScene& step : scene.procedure->steps)
    {
      const bool exchange = step.action == scene::StepAction::kExchange;
      const std::string& moved = exchange ? step.replacement : step.instrument;
      const std::string& goal = step.until.tip_in.empty() ? step.until.balloon_in : step.until.tip_in;
      if (moved != scene.instruments[k].instrument.name || goal.empty() || locator.find(goal) < 0)
        continue;
      const std::vector<bool> way = locator.pathBetween(entered, locator.find(goal));
      ways[k].resize(way.size(), false);
      for (std::size_t b = 0; b < way.size(); ++b)
        ways[k][b] = ways[k][b] || way[b];
    }
  for (std::vector<bool>& way : ways)
    if (way.empty())
      way.assign(static_cast<std::size_t>(places.branches()), true);
  return ways;
}

/** The instrument that reaches furthest. */
int foremostOf(const procedure::Observation& observation)
{
  const auto further = [](const procedure::InstrumentView& a, const procedure::InstrumentView& b)
  { return a.hand.insertion < b.hand.insertion; };
  return static_cast<int>(std::max_element(observation.instruments.begin(), observation.instruments.end(), further) -
                          observation.instruments.begin());
}

const char* word(procedure::Progress progress)
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

void Sample::addContact(const Eigen::Vector3d& position, double force)
{
  wall_force += force;
  largest = std::max(largest, force);
  const procedure::InstrumentView& foremost =
      observation.instruments[static_cast<std::size_t>(foremostOf(observation))];
  if ((position - foremost.tip).norm() < kTipReach)
    at_tip += force;
}

SessionMetrics::SessionMetrics(const scene::Scene& scene, const vessel::CentrelineTree& tree,
                               const Eigen::Vector3d& entry)
  : scene_(scene),
    locator_(tree, scene.procedure ? scene.procedure->branches : std::vector<scene::NamedBranch>()),
    on_way_(waysOf(scene, locator_, locator_.at(entry).branch)),
    wrong_now_(scene.instruments.size(), -1),
    ahead_(scene.instruments.size(), false),
    ahead_time_(scene.instruments.size(), 0.0),
    was_in_(scene.instruments.size(), false),
    entries_(scene.instruments.size(), 0)
{
}

bool SessionMetrics::wants(double time) const
{
  return static_cast<std::int64_t>(std::floor(time * kRate + 1e-6)) > last_slot_;
}

void SessionMetrics::add(Sample sample)
{
  if (!wants(sample.observation.time))
    return;
  last_slot_ = static_cast<std::int64_t>(std::floor(sample.observation.time * kRate + 1e-6));
  followBranches(sample);
  followWires(sample);
  followExchanges(sample);
  followForces(sample);
  samples_.push_back(std::move(sample));
}

void SessionMetrics::setSteps(std::vector<procedure::StepRecord> steps, std::string failure)
{
  steps_ = std::move(steps);
  failure_ = std::move(failure);
}

void SessionMetrics::addEvent(const std::string& kind, int instrument, double time)
{
  if (kind != "stent_placed")
    mishaps_.push_back({kind, instrument, time, 0.0, ""});
}

const std::string& SessionMetrics::nameOf(int instrument) const
{
  return scene_.instruments[static_cast<std::size_t>(instrument)].instrument.name;
}

void SessionMetrics::followBranches(const Sample& sample)
{
  for (std::size_t k = 0; k < wrong_now_.size(); ++k)
  {
    const procedure::BranchPosition& place = sample.observation.instruments[k].branch_position;
    const bool wrong = !sample.observation.instruments[k].covered && place.branch >= 0 &&
                       !on_way_[k][static_cast<std::size_t>(place.branch)];
    int& now = wrong_now_[k];
    if (now >= 0 && (!wrong || wrong_[static_cast<std::size_t>(now)].branch != place.branch))
      now = -1;
    if (wrong && now < 0 && place.depth > kNoticed)
    {
      now = static_cast<int>(wrong_.size());
      wrong_.push_back(
          {static_cast<int>(k), place.branch, sample.observation.time, sample.observation.time, place.depth});
    }
    if (now < 0)
      continue;
    WrongBranch& stay = wrong_[static_cast<std::size_t>(now)];
    stay.end = sample.observation.time;
    stay.deepest = std::max(stay.deepest, place.depth);
  }
}

/** A balloon catheter is never to go ahead of the wire that leads it. */
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
      mishaps_.push_back({"balloon ahead of its wire", static_cast<int>(k), sample.observation.time, lead, "m"});
    ahead_[k] = ahead;
    ahead_time_[k] += ahead ? 1.0 / kRate : 0.0;
  }
}

/** An exchange: something has left, then something enters. */
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
  if (sample.at_tip <= kPerforation ||
      scene_.instruments[static_cast<std::size_t>(foremost)].instrument.kind != instrument::Kind::kGuidewire)
    return;
  if (sample.observation.time > pressing_until_ + kSameTime)
  {
    pressing_ = mishaps_.size();
    mishaps_.push_back({"risk of perforation", foremost, sample.observation.time, sample.at_tip, "N"});
  }
  mishaps_[pressing_].value = std::max(mishaps_[pressing_].value, sample.at_tip);
  pressing_until_ = sample.observation.time;
}

/** Time in which some hand moves: a person looks at X-rays while he moves something. [s] */
double SessionMetrics::handTime() const
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
  for (const WrongBranch& stay : wrong_)
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

Json SessionMetrics::json() const
{
  Json json = {{"scene", scene_.name}};
  json["procedure"] = scene_.procedure ? Json(scene_.procedure->name) : Json(nullptr);
  if (!steps_.empty())
    json["outcome"] = word(steps_.back().outcome);
  json["failure"] = failure_.empty() ? Json(nullptr) : Json(failure_);
  json["procedure_time"] = samples_.empty() ? 0.0 : samples_.back().observation.time;
  json["fluoroscopy_time"] = scene_.fluoroscopy ? handTime() : 0.0;
  json["instrument_exchanges"] = exchanges_;
  json["steps"] = Json::array();
  for (const procedure::StepRecord& step : steps_)
    json["steps"].push_back({{"phase", step.phase},
                             {"step", step.name},
                             {"begin", step.begin},
                             {"end", step.end},
                             {"new_tries", step.retries},
                             {"wrong_branches", step.wrong_branches},
                             {"outcome", word(step.outcome)}});
  json["instruments"] = Json::array();
  for (std::size_t k = 0; k < was_in_.size(); ++k)
    json["instruments"].push_back(instrumentJson(k));
  json["wrong_branches"] = Json::array();
  for (const WrongBranch& stay : wrong_)
    json["wrong_branches"].push_back({{"instrument", nameOf(stay.instrument)},
                                      {"branch", locator_.name(stay.branch)},
                                      {"begin", stay.begin},
                                      {"end", stay.end},
                                      {"deepest", stay.deepest}});
  json["wall_forces"] = wall_forces_ ? toJson(*wall_forces_, 0) : Json(nullptr);
  if (wall_forces_)
    json["wall_forces"].erase("triangles");
  json["lesions"] = toJson(lesions_);
  json["errors"] = Json::array();
  for (const Mishap& mishap : mishaps_)
  {
    Json error = {{"error", mishap.kind}, {"instrument", nameOf(mishap.instrument)}, {"time", mishap.time}};
    if (!mishap.unit.empty())
      error["value"] = mishap.value;
    json["errors"].push_back(error);
  }
  return json;
}

}  // namespace endovascular_sim::results
