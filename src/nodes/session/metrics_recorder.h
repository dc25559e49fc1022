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

/** Feeds the metrics of a session from the graph's messages, live or of a recording. What comes before the vessel is
 *  not counted. */
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
  /** Pressure commanded at the inflators, per instrument [Pa]. */
  void setPressures(const std::vector<double>& pressures) { pressures_ = pressures; }

  /** Measures the lesions, then writes metrics.json, metrics.html and instruments.csv; nothing where no vessel came.
   *  @throws InputError when the disk refuses them */
  void write(const std::string& folder, const results::WallForceSummary* forces);

private:
  void begin();

  scene::Scene scene_;
  vessel::Vessel vessel_;                             ///< as it was at the beginning
  geometry::TriangleMesh wall_;                       ///< as it is now
  std::vector<intervention::RoundBody> stents_;       ///< opened ones
  std::unique_ptr<results::SessionMetrics> metrics_;  ///< null before the vessel
  std::vector<procedure::StepRecord> steps_;
  std::string failure_;
  std::vector<double> pressures_;
  std::vector<std::pair<Eigen::Vector3d, double>> contacts_;  ///< newest: place [m] and normal force [N]
};

/** The observation that a message holds.
 *  @param pressures per instrument; may be empty */
procedure::Observation observationFrom(const RodStateVisual& rod, const scene::Scene& scene,
                                       const procedure::BranchLocator& locator, const std::vector<double>& pressures);

}  // namespace endovascular_sim::nodes
