#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "flow/coupling/flow_source.h"
#include "scene/model/scene.h"

namespace endovascular_sim::results
{

/** Pressures of a session, beat by beat, and the fractional flow reserve of its lesions: the mean pressure behind a
 *  lesion divided by that before it, in hyperaemia (Pijls et al. 1996). At rest the same ratio is Pd/Pa. */
class PressureCourse
{
public:
  /** Ratios of a lesion, or of a pressure wire; empty where they were not measured. */
  struct Reserve
  {
    std::optional<double> rest_before;  ///< Pd/Pa before the first hyperaemia; without one, of the first beat [1]
    std::optional<double> rest_after;   ///< Pd/Pa before the last of several; without one, of the last beat [1]
    std::optional<double> before;       ///< reserve in the first hyperaemia [1]
    std::optional<double> after;        ///< reserve in the last hyperaemia, if there are two [1]
  };

  /** Adds the mean values of a beat; those of the newest one change nothing.
   *  @param time at which they are known [s] */
  void add(double time, const flow::BeatMeans& means);

  /** The same without the beats after a time [s]. */
  PressureCourse until(double time) const;

  bool empty() const { return times_.empty(); }
  const std::vector<double>& times() const { return times_; }           ///< ends of the beats [s]
  const std::vector<flow::BeatMeans>& beats() const { return means_; }  ///< one per time

  /** Reserve of a lesion, by the pressures in the vessel. */
  Reserve ofLesion(std::size_t lesion) const;

  /** Reserve that a pressure line has measured: its mean divided by that of another one. */
  Reserve ofLines(std::size_t distal, std::size_t proximal) const;

  /** Value of `pressure` in metrics.json; SI units. Pressure lines are named by their instruments. */
  nlohmann::ordered_json json(const scene::Scene& scene) const;

private:
  template <typename Ratio>
  Reserve reserveOf(const Ratio& ratio) const;

  std::vector<double> times_;
  std::vector<flow::BeatMeans> means_;
};

}  // namespace endovascular_sim::results
