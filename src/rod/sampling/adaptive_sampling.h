#pragma once

#include <functional>
#include <vector>

#include <Eigen/Core>

#include "rod/sampling/resampling.h"
#include "rod/sampling/sampling_tree.h"
#include "rod/stepping/stepper.h"

namespace endovascular_sim
{
class Archive;
}

namespace endovascular_sim::rod
{

/** Curvature that the wire will have to follow at a place that its tip has not reached yet [1/m]. */
using CurvatureAhead = std::function<double(const Eigen::Vector3d&)>;

/** Keeps the nodes of a wire where it bends (docs/PHYSICS.md, "Adaptive sampling").
 *
 *  An edge of length h is split where κh exceeds η and merged where it falls below 0.7 η, κ being the largest curvature
 *  of the wire within three shortest edges, and near the tip also the vessel's ahead of it. Finest whatever the
 *  curvature: edges at a section joint, those outside the introducer and in the outer part of its guide (where nodes
 *  are released and the hand's force is read), and those at a clamped end. */
class AdaptiveSampling
{
public:
  AdaptiveSampling(const Wire& wire, const Boundary& boundary, const SamplingSettings& settings,
                   CurvatureAhead ahead = nullptr);

  const Discretisation& discretisation() const { return rod_; }

  /** Splits and merges by the shape of the wire, and carries the state over.
   *  @return whether the sampling changed; then the stepper must be told */
  bool update(State& state);

  /** Saves where the nodes are and what is known of the way ahead, or loads it. */
  void archive(Archive& archive);

private:
  void measureCurvature(const State& state);
  double curvatureBeyondTip(const Eigen::Vector3d& before_tip, const Eigen::Vector3d& tip);
  void demandOfShape(const State& state);
  void setFixedDemand();
  void restrictDemand(const State& state);

  Wire wire_;
  Boundary boundary_;
  SamplingSettings settings_;
  CurvatureAhead ahead_;
  SamplingTree tree_;
  Resampling resampling_;
  Discretisation rod_, next_rod_;
  std::vector<double> position_;
  std::vector<double> curvature_;  ///< per node [1/m]
  std::vector<SamplingDemand> demand_;
  double beyond_tip_ = -1.0;  ///< curvature ahead of where the tip was when it last looked; negative: never [1/m]
  Eigen::Vector3d looked_from_ = Eigen::Vector3d::Zero();
};

}  // namespace endovascular_sim::rod
