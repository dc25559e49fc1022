#pragma once

#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "endovascular_sim/ContactForces.h"
#include "endovascular_sim/ProcedureStep.h"
#include "endovascular_sim/RodStateVisual.h"
#include "endovascular_sim/TreatmentVisual.h"
#include "endovascular_sim/VesselCentreline.h"
#include "endovascular_sim/VesselMesh.h"
#include "endovascular_sim/WallDisplacement.h"
#include "results/session_metrics.h"
#include "scene/model/scene.h"

namespace endovascular_sim::nodes
{

/** Metrics of a session from the messages of the graph, live or recorded. Messages before the vessel are ignored. */
class MetricsRecorder
{
public:
  explicit MetricsRecorder(scene::Scene scene) : scene_(std::move(scene)) {}

  void add(const VesselMesh& mesh);
  void add(const VesselCentreline& centreline);
  void add(const RodStateVisual& rod);
  void add(const ContactForces& forces);
  void add(const ProcedureStep& step);
  void add(const WallDisplacement& moved);
  void add(const TreatmentVisual& treatment);
  /** Sets the commanded pressure at the inflator of every instrument [Pa]. */
  void setPressures(const std::vector<double>& pressures) { pressures_ = pressures; }

  /** Evaluates the lesions and writes metrics.json, metrics.html and instruments.csv; without a vessel it does nothing.
   *  @throws InputError when a file cannot be written */
  void write(const std::string& folder, const results::WallForceSummary* forces);

private:
  void begin();

  scene::Scene scene_;
  vessel::Vessel vessel_;                             ///< initial vessel
  geometry::TriangleMesh wall_;                       ///< current wall
  std::vector<intervention::RoundBody> stents_;       ///< opened stents
  std::unique_ptr<results::SessionMetrics> metrics_;  ///< null before the vessel
  std::vector<procedure::StepRecord> steps_;
  std::string failure_;
  std::vector<double> pressures_;
  std::vector<std::pair<Eigen::Vector3d, double>> contacts_;  ///< newest contacts: position [m] and normal force [N]
};

/** Observation in a message.
 *  @param pressures pressure at the inflator of every instrument [Pa]; may be empty */
procedure::Observation observationFrom(const RodStateVisual& rod, const scene::Scene& scene,
                                       const procedure::BranchLocator& locator, const std::vector<double>& pressures);

}  // namespace endovascular_sim::nodes
