#include "results/pressure_course.h"

#include <algorithm>

#include <nlohmann/json.hpp>

#include "instrument/instrument.h"

namespace endovascular_sim::results
{
namespace
{

using Json = nlohmann::ordered_json;

constexpr std::size_t kSettled = 6;           // beats of a hyperaemia after which pressures have settled
constexpr std::size_t kBeforeHyperaemia = 2;  // beats from the last one at rest to the first of a hyperaemia, which
                                              // begins within the one between
constexpr double kLeastPressure = 1.0;        // mean pressure of a line that is in the vessel [Pa]

/** Beats of one uninterrupted hyperaemia. */
struct Period
{
  std::size_t first = 0, last = 0;

  /** Beat at which its reserve is read: as soon as the pressures have settled. */
  std::size_t reading() const { return std::min(first + kSettled, last); }
};

std::vector<Period> hyperaemiasOf(const std::vector<flow::BeatMeans>& beats)
{
  std::vector<Period> periods;
  for (std::size_t k = 0; k < beats.size(); ++k)
  {
    if (!beats[k].hyperaemia)
      continue;
    if (periods.empty() || periods.back().last + 1 != k)
      periods.push_back({k, k});
    periods.back().last = k;
  }
  return periods;
}

/** Sets the ratios at rest: those of the last whole beat before the first and before the last hyperaemia. Without a
 *  hyperaemia, those of the first and the last beat with a ratio.
 *  @param ratio optional ratio of a beat */
template <typename Ratio>
void setAtRest(const std::vector<flow::BeatMeans>& beats, const std::vector<Period>& periods, const Ratio& ratio,
               PressureCourse::Reserve& reserve)
{
  if (!periods.empty())
  {
    if (periods.front().first >= kBeforeHyperaemia)
      reserve.rest_before = ratio(beats[periods.front().first - kBeforeHyperaemia]);
    if (periods.size() > 1 && !beats[periods.back().first - kBeforeHyperaemia].hyperaemia)
      reserve.rest_after = ratio(beats[periods.back().first - kBeforeHyperaemia]);
    return;
  }
  for (const flow::BeatMeans& beat : beats)
  {
    const std::optional<double> found = ratio(beat);
    if (found && !reserve.rest_before)
      reserve.rest_before = found;
    if (found)
      reserve.rest_after = found;
  }
}

Json numberOrNull(const std::optional<double>& value)
{
  return value ? Json(*value) : Json(nullptr);
}

void add(Json& json, const PressureCourse::Reserve& reserve)
{
  json["pd_pa_before"] = numberOrNull(reserve.rest_before);
  json["pd_pa_after"] = numberOrNull(reserve.rest_after);
  json["ffr_before"] = numberOrNull(reserve.before);
  json["ffr_after"] = numberOrNull(reserve.after);
}

}  // namespace

void PressureCourse::add(double time, const flow::BeatMeans& means)
{
  if (!(means.root > 0.0) || (!means_.empty() && means.step <= means_.back().step))
    return;
  times_.push_back(time);
  means_.push_back(means);
}

PressureCourse PressureCourse::until(double time) const
{
  PressureCourse course;
  for (std::size_t k = 0; k < times_.size() && times_[k] <= time; ++k)
    course.add(times_[k], means_[k]);
  return course;
}

/** @param ratio optional ratio of a beat */
template <typename Ratio>
PressureCourse::Reserve PressureCourse::reserveOf(const Ratio& ratio) const
{
  Reserve reserve;
  const std::vector<Period> periods = hyperaemiasOf(means_);
  setAtRest(means_, periods, ratio, reserve);
  for (const Period& period : periods)
  {
    const std::optional<double> found = ratio(means_[period.reading()]);
    if (found && !reserve.before)
      reserve.before = found;
    else if (found)
      reserve.after = found;
  }
  return reserve;
}

PressureCourse::Reserve PressureCourse::ofLesion(std::size_t lesion) const
{
  return reserveOf([lesion](const flow::BeatMeans& beat) -> std::optional<double>
                   { return beat.lesions.at(lesion) / beat.root; });
}

PressureCourse::Reserve PressureCourse::ofLines(std::size_t distal, std::size_t proximal) const
{
  return reserveOf(
      [distal, proximal](const flow::BeatMeans& beat) -> std::optional<double>
      {
        const double behind = beat.readings.at(distal), before = beat.readings.at(proximal);
        return behind > kLeastPressure && before > kLeastPressure ? std::optional<double>(behind / before)
                                                                  : std::nullopt;
      });
}

Json PressureCourse::json(const scene::Scene& scene) const
{
  Json json = {{"beats", times_.size()}, {"lesions", Json::array()}, {"wires", Json::array()}};
  if (empty())
    return json;
  json["mean_pressure_first"] = means_.front().root;
  json["mean_pressure_last"] = means_.back().root;
  for (std::size_t k = 0; k < means_.front().lesions.size(); ++k)
  {
    Json lesion = {{"lesion", k}};
    results::add(lesion, ofLesion(k));
    json["lesions"].push_back(lesion);
  }
  std::vector<std::string> names;
  for (const scene::DrivenInstrument& driven : scene.instruments)
    if (instrument::pressureLineOf(driven.instrument))
      names.push_back(driven.instrument.name);
  for (std::size_t k = 0; k + 1 < names.size(); ++k)
  {
    Json wire = {{"instrument", names[k]}, {"catheter", names.back()}};
    results::add(wire, ofLines(k, names.size() - 1));
    json["wires"].push_back(wire);
  }
  return json;
}

}  // namespace endovascular_sim::results
