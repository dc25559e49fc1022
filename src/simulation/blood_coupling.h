#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include <Eigen/Core>

#include "contrast/lumen/lumen_cells.h"
#include "flow/body/lesion_lumen.h"
#include "flow/coupling/flow_engine.h"
#include "flow/coupling/flow_places.h"
#include "flow/coupling/flow_source.h"
#include "flow/coupling/tree_path.h"
#include "rod/model/discretisation.h"
#include "rod/model/state.h"
#include "rod/stepping/stepper.h"
#include "scene/model/scene.h"
#include "scene/scene_vessel.h"
#include "simulation/balloon_treatments.h"
#include "simulation/motion_coupling.h"
#include "vessel/model/vessel.h"

namespace endovascular_sim::simulation
{

/** Pressure lines of a scene's instruments. */
std::vector<flow::LineSettings> pressureLines(const scene::Scene& scene);

/** Lumen of the vessel of a scene with flow, divided into the cells of its contrast medium.
 *  @throws InputError as makeFlowEngine() */
struct ContrastVessel
{
  ContrastVessel(const scene::Scene& scene, const vessel::Vessel& vessel);

  contrast::ContrastCells cells;
  std::shared_ptr<const contrast::LumenCells> lumen;
};

/** Flow engine of a scene with the key `flow`.
 *  @param contrast of the vessel, for a scene with contrast medium; null: it is divided anew
 *  @throws InputError for a vessel without a centreline, or with one that is no tree */
flow::FlowEngine makeFlowEngine(const scene::Scene& scene, const vessel::Vessel& vessel,
                                const ContrastVessel* contrast = nullptr);

/** Tree of a vessel for couplings with the flow of blood. It does not change; any number of couplings share it. */
struct BloodVessel
{
  BloodVessel(const scene::Scene& scene, const vessel::Vessel& vessel);

  flow::TreePaths paths;
  flow::FlowPlaces places;
  flow::LesionLumens lumens;  ///< each coupling measures with a copy
};

/** Coupling of the instruments with the flow of blood: what they leave of the lumen, and what the blood does to them.
 *
 *  Every FlowScene::time_step a step of the flow is begun, and the one before is taken. A result therefore acts one
 * such step later: enough time to compute it elsewhere, and the same in every process. */
class BloodCoupling
{
public:
  /** @param vessel not null
   *  @param source of the steps of the flow */
  BloodCoupling(const scene::Scene& scene, std::shared_ptr<const BloodVessel> vessel, const scene::EntryPose& entry,
                std::shared_ptr<flow::FlowSource> source);

  /** Inputs of the steps of the flow from the next one on. @{ */
  void setControls(const flow::FlowControls& controls) { controls_ = controls; }
  const flow::FlowControls& controls() const { return controls_; }
  /** @} */

  /** True when the step with this number begins a step of the flow. */
  bool isDue(std::uint64_t step) const { return step % period_ == 0; }

  /** Sets what is injected during the next step of the flow, and no longer. */
  void setInjection(flow::FlowInjection injection) { request_.injection = std::move(injection); }

  /** Path of an instrument in the vessel, from its tip to the introducer; empty for one outside.
   *  @param at_rest places of the nodes in the vessel at rest [m] */
  flow::TreePath pathOf(int instrument, const rod::State& state, const std::vector<Eigen::Vector3d>& at_rest,
                        const rod::Discretisation& rod) const;

  /** True when a step of the flow has been begun and not been taken. */
  bool isPending() const { return pending_; }

  /** Takes the last step of the flow and begins the next one.
   *  @param at_rest places of the nodes in the vessel at rest [m]
   *  @param map from there to the moved patient; null: he rests
   *  @param wall vertices of the wall in which contact is detected, of version @p version
   *  @throws InputError when the source does not answer */
  void exchange(const rod::State& state, const std::vector<Eigen::Vector3d>& at_rest, const motion::MotionMap* map,
                const rod::Discretisation& rod, const BalloonTreatments& treatments,
                const std::vector<Eigen::Vector3d>& wall, std::uint64_t version);

  /** Clock of the heart at the end of a step. @param step number of the step  @param time_step of the simulation [s] */
  HeartClock heartClock(std::uint64_t step, double time_step) const;

  /** Adds the drag on soft sections, and the thrust on balloons. */
  void addLoads(const rod::State& state, const rod::Discretisation& rod, rod::StepInput& input) const;

  /** Pressure and flow that act in the present step; null before the first result. */
  const flow::FlowField* field() const { return now_ ? &now_->field : nullptr; }

  const flow::FlowPlaces& places() const { return vessel_->places; }
  const flow::TreePaths& paths() const { return vessel_->paths; }

  /** Index of the pressure line of an instrument; −1 without one. */
  int lineOf(int instrument) const;

  std::uint64_t steps() const { return request_.step; }  ///< number of steps of the flow that have been begun

  void archive(Archive& archive);

private:
  /** Piece of an instrument with one radius. */
  struct Piece
  {
    double begin = 0.0;  ///< distances from the tip [m]
    double end = 0.0;
    double radius = 0.0;
  };

  /** Velocity of the blood at a point of the wire. */
  struct StreamSample
  {
    double from_end = 0.0;  ///< distance from the end of the wire [m]
    Eigen::Vector3d velocity = Eigen::Vector3d::Zero();
    double axial = 0.0;      ///< drag per length and speed along the wire [N·s/m²]
    double crosswise = 0.0;  ///< the same across it

    void archive(Archive& archive);
  };

  /** Thrust on a balloon. */
  struct Thrust
  {
    int instrument = 0;
    double from_end = 0.0;  ///< distance of the balloon's centre from the end of the wire [m]
    double force = 0.0;     ///< along the wire, positive to its tip [N]

    void archive(Archive& archive);
  };

  void take();
  void describeInstruments(const rod::State& state, const std::vector<Eigen::Vector3d>& at_rest,
                           const rod::Discretisation& rod, const BalloonTreatments& treatments);
  void sampleStream(const rod::State& state, const std::vector<Eigen::Vector3d>& at_rest, const motion::MotionMap* map,
                    const rod::Discretisation& rod);
  void findThrusts(const rod::State& state, const BalloonTreatments& treatments);
  bool isSoft(const rod::Discretisation& rod, int node) const;
  StreamSample sampleAt(const rod::State& state, const rod::Discretisation& rod, int node,
                        const flow::TreePlace& place) const;

  std::uint64_t period_;  ///< steps of the simulation per step of the flow
  scene::FlowScene settings_;
  std::shared_ptr<const BloodVessel> vessel_;
  flow::LesionLumens lumens_;
  std::shared_ptr<flow::FlowSource> source_;
  flow::TreePlace entry_;
  std::vector<std::vector<Piece>> pieces_;  ///< of each instrument
  std::vector<std::optional<instrument::PressureLine>> lines_;
  std::vector<int> line_of_;
  std::vector<double> radii_;  ///< of the lumen at each cell [m]
  flow::FlowControls controls_;
  flow::FlowRequest request_;
  std::uint64_t measured_version_ = 0;
  bool is_measured_ = false;
  bool pending_ = false;
  std::optional<flow::FlowAnswer> now_, next_;
  std::vector<StreamSample> stream_;
  std::vector<Thrust> thrusts_;
};

}  // namespace endovascular_sim::simulation
