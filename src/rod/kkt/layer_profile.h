#pragma once

#include <vector>

#include <Eigen/Core>

#include "rod/model/discretisation.h"

namespace endovascular_sim::rod
{

/** One layer of a concentric stack on nodes that need not be its own: what it gives to every node, and how that
 *  changes as it slides over them.
 *
 *  A node's share of the layer is weighted with the node's hat function, 1 at the node and 0 at its neighbours, which
 *  stands for the same length as its cell. So all properties, and their first derivatives by the insertion, are
 *  continuous while the layer's tip or a joint of its sections passes nodes. The last node does not bend: on the last
 *  edge the weight of the one before it returns to 1 (1 − 3t + 3t²), because what a tip gains there by advancing is
 *  that node's energy per length. */
class LayerProfile
{
public:
  /** How a node's properties change with the layer's insertion, the nodes held [1/m of each]. */
  struct Slope
  {
    double mass = 0.0;
    double cover = 0.0;
    double radius = 0.0;
  };

  LayerProfile(Wire wire, const std::vector<double>& position);

  /** Puts the layer on the nodes at other places, as if new. */
  void setNodes(const std::vector<double>& position);

  /** Puts another wire in the layer's place. */
  void setWire(Wire wire);

  /** Slides the layer to where its tip is at @p tip along the nodes [m]. The first section counts as reaching back as
   *  far as there are nodes. What it gives to them depends on @p tip alone, not on where it was before.
   *  @param changed gets the nodes whose properties have changed, some of them perhaps twice */
  void slideTo(double tip, std::vector<int>& changed);

  /** The layer as the only one, its tip at the last node: as a wire of its own, sections cut at the cells' ends. */
  void takeWhole();

  const Wire& wire() const { return wire_; }
  double length() const { return length_; }  ///< of the wire [m]
  double tip() const { return tip_; }        ///< along the nodes [m]
  /** Where a section ends along the nodes [m]. */
  double sectionEnd(std::size_t section) const;

  /** The layer as a rod of its own: it has the nodes up to the first one beyond its tip. Stiffnesses are those of the
   *  covered part times its share of the cell; rest curvature is that of a cell as curved as the covered part. */
  const Discretisation& rod() const { return rod_; }

  /** Share of a node that the layer covers, 0 to 1. */
  double cover(int node) const { return cover_[node]; }

  /** Nodes at which a property changes as the layer slides: those next to its tip and to the joints of its sections. */
  const std::vector<int>& slidingNodes() const { return sliding_; }
  Slope slope(int node) const;

private:
  struct Integrals;

  double hat(int node, double place) const;
  double hatIntegral(int node, double place) const;
  Integrals integrate(int node) const;
  Integrals integrateSlopes(int node) const;
  void setNode(int node);
  void findRange();
  void setNodesBetween(double begin, double end, std::vector<int>& changed);
  void findSlidingNodes();

  Wire wire_;
  double length_ = 0.0;
  std::vector<double> position_;  ///< of all nodes [m]
  double tip_ = 0.0;
  bool placed_ = false;
  std::vector<int> sliding_;
  Discretisation rod_;  ///< arrays over all nodes, but position_ only up to the tip
  std::vector<double> cover_;
};

}  // namespace endovascular_sim::rod
