#pragma once

#include <array>

#include <Eigen/Core>

#include "rod/boundary/introducer_guide.h"
#include "rod/stepping/stepper.h"

namespace endovascular_sim::rod
{

/** Tube of the introducer around its guide: a stiff potential in space beyond the radial clearance of the wire. Nodes
 *  touch the tube, with a stiffness that fades over the last millimetres to the mouth; its rim touches the wire inside
 *  an edge. The force on the rim is normal to the wire. Second derivatives are
 *  approximated by positive semi-definite ones. */
class IntroducerSheath
{
public:
  explicit IntroducerSheath(const Boundary& boundary);

  /** Computes the potential of the tube on a node; its terms are those of the edge's first node.
   *  @param cell Voronoi length [m]
   *  @return false without contact */
  bool evaluateNode(const Eigen::Vector3d& position, double cell, GuidedEdge& node) const;

  /** Computes the potential of the rim on an edge that crosses the plane of the mouth.
   *  @return false without contact */
  bool evaluateRim(const Eigen::Vector3d& first, const Eigen::Vector3d& second, GuidedEdge& edge) const;

  /** True before the plane of the mouth. */
  bool isInside(const Eigen::Vector3d& position) const { return direction_.dot(position - origin_) < 0.0; }

private:
  Eigen::Vector3d origin_, direction_;
  double clearance_;  ///< [m]
};

}  // namespace endovascular_sim::rod
