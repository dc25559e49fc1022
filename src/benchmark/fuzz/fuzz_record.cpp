#include "benchmark/fuzz/fuzz_record.h"

#include <algorithm>
#include <utility>

#include <nlohmann/json.hpp>

#include "benchmark/harness/table.h"
#include "common/error.h"

namespace endovascular_sim::benchmark
{
namespace
{

using Json = nlohmann::ordered_json;

constexpr std::size_t kWorst = 20;  // number of retained episodes

Json toJson(const FuzzEpisode& e)
{
  return {{"episode", e.number},
          {"vessel", e.vessel},
          {"what", e.description},
          {"steps", e.steps},
          {"checks", e.checks},
          {"bad_step", e.bad_step},
          {"escaped", e.escaped},
          {"finite", e.finite},
          {"refused", e.rejected},
          {"hit_iteration_limit", e.hit_iteration_limit},
          {"depth", e.depth},
          {"depth_step", e.depth_step},
          {"depth_place", e.depth_place},
          {"hand_force", e.force},
          {"over_grips", e.over_grips},
          {"max_strain", e.max_strain}};
}

/** Value of a key, or of its name in records of former versions. */
const Json& present(const Json& json, const char* key, const char* former)
{
  return json.at(json.contains(former) ? former : key);
}

FuzzEpisode episodeOf(const Json& json)
{
  FuzzEpisode e;
  e.number = json.at("episode");
  e.vessel = json.at("vessel");
  e.description = json.at("what");
  e.steps = json.at("steps");
  e.checks = present(json, "checks", "looks");
  e.bad_step = json.at("bad_step");
  e.escaped = json.at("escaped");
  e.finite = json.at("finite");
  e.rejected = json.at("refused");
  e.hit_iteration_limit = present(json, "hit_iteration_limit", "capped");
  e.depth = json.at("depth");
  e.depth_step = json.at("depth_step");
  e.depth_place = json.at("depth_place");
  e.force = json.at("hand_force");
  e.over_grips = json.at("over_grips");
  e.max_strain = json.at("max_strain");
  return e;
}

Table worstTable(const std::vector<FuzzEpisode>& worst)
{
  Table table({"episode", "vessel", "depth [mm]", "at step", "from the introducer [mm]", "escaped", "not finite",
               "refused", "hand [N]", "of the grips", "strain", "what"});
  for (const FuzzEpisode& e : worst)
    table.add({std::to_string(e.number), e.vessel, number(1e3 * e.depth), std::to_string(e.depth_step),
               number(1e3 * e.depth_place), e.escaped ? "yes" : "no", e.finite ? "no" : "yes",
               std::to_string(e.rejected), number(e.force), number(e.over_grips, 3), number(e.max_strain, 2),
               e.description});
  return table;
}

}  // namespace

FuzzRecord::FuzzRecord(FuzzSettings settings, std::vector<std::string> kinds)
  : settings_(std::move(settings)), kinds_(std::move(kinds))
{
}

bool FuzzRecord::isWorse(const FuzzEpisode& a, const FuzzEpisode& b) const
{
  const auto rank = [](const FuzzEpisode& e)
  { return (e.finite ? 0 : 4) + (e.escaped ? 2 : 0) + (e.over_grips > kFuzzOverGrips ? 1 : 0); };
  return rank(a) != rank(b) ? rank(a) > rank(b) : a.depth > b.depth;
}

void FuzzRecord::add(const FuzzEpisode& episode)
{
  next_ = episode.number + 1;
  steps_ += static_cast<std::uint64_t>(episode.steps);
  checks_ += static_cast<std::uint64_t>(episode.checks);
  escapes_ += episode.escaped;
  not_finite_ += !episode.finite;
  too_deep_ += episode.depth > kFuzzDepth;
  too_strong_ += episode.over_grips > kFuzzOverGrips;
  over_grips_ = std::max(over_grips_, episode.over_grips);
  rejected_ += static_cast<std::uint64_t>(episode.rejected);
  hit_iteration_limit_ += static_cast<std::uint64_t>(episode.hit_iteration_limit);
  VesselTotal& total = vessels_[episode.vessel];
  ++total.episodes;
  total.steps += static_cast<std::uint64_t>(episode.steps);
  total.escapes += episode.escaped;
  total.depth = std::max(total.depth, episode.depth);
  const auto position = std::upper_bound(worst_.begin(), worst_.end(), episode,
                                         [this](const FuzzEpisode& a, const FuzzEpisode& b) { return isWorse(a, b); });
  worst_.insert(position, episode);
  worst_.resize(std::min(worst_.size(), kWorst));
}

std::string FuzzRecord::json() const
{
  Json vessels = Json::array();
  for (const auto& [name, total] : vessels_)
    vessels.push_back({{"name", name},
                       {"episodes", total.episodes},
                       {"steps", total.steps},
                       {"escapes", total.escapes},
                       {"depth", total.depth}});
  Json worst = Json::array();
  for (const FuzzEpisode& episode : worst_)
    worst.push_back(toJson(episode));
  const Json json = {{"seed", settings_.seed},
                     {"steps_per_episode", settings_.steps_per_episode},
                     {"coaxial", settings_.coaxial},
                     {"moving", settings_.moving},
                     {"overrides", settings_.overrides},
                     {"kinds", kinds_},
                     {"good", good()},
                     {"next_episode", next_},
                     {"steps", steps_},
                     {"checks", checks_},
                     {"escapes", escapes_},
                     {"not_finite", not_finite_},
                     {"too_deep", too_deep_},
                     {"too_strong", too_strong_},
                     {"over_grips", over_grips_},
                     {"depth", depth()},
                     {"refused_steps", rejected_},
                     {"steps_at_solve_limit", hit_iteration_limit_},
                     {"vessels", vessels},
                     {"worst", worst}};
  return json.dump(2) + "\n";
}

void FuzzRecord::resume(const std::string& text, const std::string& origin)
{
  try
  {
    const Json json = Json::parse(text);
    if (json.at("seed") != settings_.seed || json.at("steps_per_episode") != settings_.steps_per_episode ||
        json.at("coaxial") != settings_.coaxial || json.at("moving") != settings_.moving ||
        json.at("overrides") != Json(settings_.overrides) || json.at("kinds") != Json(kinds_))
      throw InputError(origin, "",
                       "belongs to another seed, episode length, overrides or list of vessels; give the same "
                       "ones, or another --out");
    next_ = json.at("next_episode");
    steps_ = json.at("steps");
    checks_ = present(json, "checks", "looks");
    escapes_ = json.at("escapes");
    not_finite_ = json.at("not_finite");
    too_deep_ = json.at("too_deep");
    too_strong_ = json.at("too_strong");
    over_grips_ = json.at("over_grips");
    rejected_ = json.at("refused_steps");
    hit_iteration_limit_ = json.at("steps_at_solve_limit");
    vessels_.clear();
    for (const Json& v : json.at("vessels"))
      vessels_[v.at("name")] = {v.at("episodes"), v.at("steps"), v.at("escapes"), v.at("depth")};
    worst_.clear();
    for (const Json& e : json.at("worst"))
      worst_.push_back(episodeOf(e));
  }
  catch (const nlohmann::json::exception& error)
  {
    throw InputError(origin, "", std::string("is damaged (") + error.what() + "); remove it to restart");
  }
}

std::string FuzzRecord::csv() const
{
  return worstTable(worst_).csv();
}

std::string FuzzRecord::markdown(const std::string& command, const std::vector<std::string>& skipped) const
{
  std::string text = "# Leak fuzz\n\n" + std::to_string(steps_) + " steps in " + std::to_string(next_) +
                     " episodes, the whole wire checked " + std::to_string(checks_) +
                     " times: " + std::to_string(escapes_) + " escapes, " + std::to_string(not_finite_) +
                     " not finite, " + std::to_string(too_deep_) + " deeper than " + number(1e3 * kFuzzDepth) +
                     " mm beyond the wall's compliance (deepest " + number(1e3 * depth()) + " mm), " +
                     std::to_string(too_strong_) + " with a hand beyond " + number(kFuzzOverGrips) +
                     " of the grips (largest " + number(over_grips_, 3) + "), " + std::to_string(rejected_) +
                     " steps rejected. " + (good() ? "Good." : "NOT GOOD.") + "\n\n";
  Table totals({"vessel", "episodes", "steps", "escapes", "deepest [mm]"});
  for (const auto& [name, total] : vessels_)
    totals.add({name, std::to_string(total.episodes), std::to_string(total.steps), std::to_string(total.escapes),
                number(1e3 * total.depth)});
  text += totals.markdown() + "\n";
  for (const std::string& reason : skipped)
    text += "- Skipped: " + reason + "\n";
  text +=
      "\n## The worst episodes\n\n`" + command + " --episode N` reruns episode N.\n\n" + worstTable(worst_).markdown();
  return text;
}

}  // namespace endovascular_sim::benchmark
