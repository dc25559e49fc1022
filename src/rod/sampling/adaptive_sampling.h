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

/** Curvature of the vessel at a point ahead of the tip [1/m]. */
using CurvatureAhead = std::function<double(const Eigen::Vector3d&)>;

/** Adaptive sampling of a wire by its curvature (docs/PHYSICS.md, "Adaptive sampling").
 *
 *  An edge of length h is split where κh exceeds η and merged where it falls below 0.7 η. κ is the largest curvature of
 *  the wire within three shortest edges, and near the tip also that of the vessel ahead. Some edges are finest whatever
 *  the curvature: those at a section joint, at a clamped end, outside the introducer and in the outer part of its
 * guide, where nodes are released and the force on the hand is computed. */
class AdaptiveSampling
{
public:
  AdaptiveSampling(const Wire& wire, const Boundary& boundary, const SamplingSettings& settings,
                   CurvatureAhead ahead = nullptr);

  const Discretisation& discretisation() const { return rod_; }

  /** Splits and merges edges by the shape of the wire, and transfers the state.
   *  @param at_rest places of the nodes in a vessel at rest, whose curvature counts ahead of the tip; null: the
   *         positions of the state
   *  @return true when the sampling changed; the stepper then needs Stepper::resample() */
  bool update(State& state, const std::vector<Eigen::Vector3d>* at_rest = nullptr);

  /** Saves or loads the positions of the nodes and the curvature ahead. */
  void archive(Archive& archive);

private:
  void measureCurvature(const State& state, const std::vector<Eigen::Vector3d>& at_rest);
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
  std::vector<double> curvature_;  ///< curvature per node [1/m]
  std::vector<SamplingDemand> demand_;
  double beyond_tip_ = -1.0;  ///< curvature ahead of the tip at the last query; negative: none yet [1/m]
  Eigen::Vector3d queried_from_ = Eigen::Vector3d::Zero();  ///< position of the tip at that query [m]
};

}  // namespace endovascular_sim::rod
