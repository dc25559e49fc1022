#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include <Eigen/Core>
#include <nlohmann/json_fwd.hpp>

#include "procedure/branch_locator.h"
#include "procedure/observation.h"
#include "procedure/operator.h"
#include "results/treatment_report.h"
#include "results/wall_force_map.h"
#include "scene/model/scene.h"
#include "vessel/centreline/centreline.h"

namespace endovascular_sim::results
{

/** A stay of an instrument's tip in a branch that does not lead to any goal of the procedure. */
struct WrongBranch
{
  int instrument = 0;  ///< of the scene
  int branch = -1;
  double begin = 0.0;    ///< [s]
  double end = 0.0;      ///< [s]
  double deepest = 0.0;  ///< beyond the branch's ostium [m]
};

/** Something that should not have happened. */
struct Mishap
{
  std::string kind;    ///< e.g. "balloon ahead of its wire"
  int instrument = 0;  ///< of the scene
  double time = 0.0;   ///< when it began [s]
  double value = 0.0;  ///< in the unit of the kind
  std::string unit;    ///< of the value; empty: it has none
};

/** Contacts this near to the foremost tip are what the tip pushes against [m]. */
constexpr double kTipReach = 5e-3;

/** One moment of a session. */
struct Sample
{
  procedure::Observation observation;
  double wall_force = 0.0;  ///< sum of the normal forces [N]
  double largest = 0.0;     ///< of one contact [N]
  double at_tip = 0.0;      ///< sum within kTipReach of the foremost tip [N]

  /** Counts a contact of the wall in, after `observation` is complete.
   *  @param force normal one [N] */
  void addContact(const Eigen::Vector3d& position, double force);
};

/** What a trainer wants to know of a session (docs/PROCEDURES.md says how each number is defined). Knows no clock, no
 *  messages and no simulation: the offline tool and the session node feed it with the same observations. */
class SessionMetrics
{
public:
  static constexpr double kRate = 20.0;        ///< of the samples [Hz]
  static constexpr double kPerforation = 0.5;  ///< of a guidewire's tip on the wall: from here a risk; assumed [N]

  /** @param entry the introducer, patient frame [m] */
  SessionMetrics(const scene::Scene& scene, const vessel::CentrelineTree& tree, const Eigen::Vector3d& entry);

  /** Whether a moment falls into a new sample; add() ignores those that do not. @param time [s] */
  bool wants(double time) const;
  void add(Sample sample);

  /** How the procedure went, where a scripted operator did it. */
  void setSteps(std::vector<procedure::StepRecord> steps, std::string failure);
  void setWallForces(WallForceSummary forces) { wall_forces_ = std::move(forces); }
  const std::vector<LesionOutcome>& lesions() const { return lesions_; }
  void setLesions(std::vector<LesionOutcome> lesions) { lesions_ = std::move(lesions); }
  /** An event of a treatment; kinds other than a placed stent are mishaps. */
  void addEvent(const std::string& kind, int instrument, double time);

  /** SI units. */
  nlohmann::ordered_json json() const;

  const scene::Scene& scene() const { return scene_; }
  const procedure::BranchLocator& locator() const { return locator_; }
  const std::vector<Sample>& samples() const { return samples_; }
  const std::vector<procedure::StepRecord>& steps() const { return steps_; }
  const std::vector<WrongBranch>& wrongBranches() const { return wrong_; }
  const std::vector<Mishap>& mishaps() const { return mishaps_; }

private:
  void followBranches(const Sample& sample);
  void followWires(const Sample& sample);
  void followExchanges(const Sample& sample);
  void followForces(const Sample& sample);
  nlohmann::ordered_json instrumentJson(std::size_t k) const;
  double handTime() const;
  const std::string& nameOf(int instrument) const;

  scene::Scene scene_;
  procedure::BranchLocator locator_;
  std::vector<std::vector<bool>> on_way_;  ///< per instrument: to any goal of its steps
  std::vector<Sample> samples_;
  std::int64_t last_slot_ = -1;
  std::vector<procedure::StepRecord> steps_;
  std::string failure_;
  std::optional<WallForceSummary> wall_forces_;
  std::vector<LesionOutcome> lesions_;
  std::vector<WrongBranch> wrong_;
  std::vector<int> wrong_now_;  ///< per instrument: index of the stay that goes on, −1
  std::vector<Mishap> mishaps_;
  std::vector<bool> ahead_;         ///< per instrument: further than every wire
  std::vector<double> ahead_time_;  ///< [s]
  std::size_t pressing_ = 0;        ///< the newest mishap of this kind
  double pressing_until_ = -1e9;    ///< with a force that may perforate [s]
  std::vector<bool> was_in_;        ///< per instrument
  std::vector<int> entries_;        ///< of every instrument into the introducer
  int withdrawn_ = 0;               ///< instruments that left and were not followed by another one yet
  int exchanges_ = 0;
};

}  // namespace endovascular_sim::results
