#pragma once

#include <vector>

#include <Eigen/Core>

#include "rod/model/discretisation.h"

namespace endovascular_sim::rod
{

/** Properties of one layer of a concentric stack on the nodes of the stack, and their derivatives by its insertion.
 *
 *  The layer's properties are weighted with the hat function of each node, 1 at the node and 0 at its neighbours, whose
 *  integral is the length of the node's cell. All properties and their first derivatives by the insertion are therefore
 *  continuous while the layer's tip or a joint of its sections passes nodes. The last node does not bend: on the last
 *  edge the weight of the node before it returns to 1 (1 − 3t + 3t²), because a tip that advances there gains that
 * node's energy per length. */
class LayerProfile
{
public:
  /** Derivatives of a node's properties by the layer's insertion, at fixed nodes. */
  struct Slope
  {
    double mass = 0.0;    ///< [kg/m]
    double cover = 0.0;   ///< [1/m]
    double radius = 0.0;  ///< [1]
  };

  LayerProfile(Wire wire, const std::vector<double>& position);

  /** Sets other nodes; the layer then needs a new position. */
  void setNodes(const std::vector<double>& position);

  /** Slides the layer until its tip is at the arc length @p tip of the nodes [m]. The first section is extended back to
   *  the first node. The properties depend on @p tip alone, not on earlier positions.
   *  @param changed gets the nodes whose properties have changed, some of them perhaps twice */
  void slideTo(double tip, std::vector<int>& changed);

  /** Takes the properties of the layer as the only one, its tip at the last node: those of discretise(). */
  void takeWhole();

  const Wire& wire() const { return wire_; }
  double length() const { return length_; }  ///< length of the wire [m]
  double tip() const { return tip_; }        ///< arc length of the tip along the nodes [m]
  /** Arc length of a section's end along the nodes [m]. */
  double sectionEnd(std::size_t section) const;

  /** The layer as a rod of its own, with the nodes up to the first one beyond its tip. Stiffnesses are those of the
   *  covered part times its share of the cell; the rest curvature is that of a cell as curved as the covered part. */
  const Discretisation& rod() const { return rod_; }

  /** Part of a node that the layer covers, 0 to 1. */
  double cover(int node) const { return cover_[node]; }

  /** Nodes whose properties change as the layer slides: those next to its tip and to the joints of its sections. */
  const std::vector<int>& slidingNodes() const { return sliding_; }
  Slope slope(int node) const;

private:
  struct Integrals;

  double hat(int node, double arc_length) const;
  double hatIntegral(int node, double arc_length) const;
  Integrals integrate(int node) const;
  Integrals integrateSlopes(int node) const;
  void setNode(int node);
  void findRange();
  void setNodesBetween(double begin, double end, std::vector<int>& changed);
  void findSlidingNodes();
  void findCurvedParts();

  Wire wire_;
  double length_ = 0.0;
  std::vector<double> position_;  ///< arc lengths of all nodes [m]
  double tip_ = 0.0;
  bool placed_ = false;
  std::vector<int> sliding_;
  Discretisation rod_;  ///< arrays over all nodes, except that position ends beyond the tip
  std::vector<double> cover_;
};

}  // namespace endovascular_sim::rod
