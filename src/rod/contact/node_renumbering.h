#pragma once

#include <vector>

#include "rod/model/discretisation.h"

namespace endovascular_sim
{
class Archive;
}

namespace endovascular_sim::rod
{

/** Nodes from begin to before end, by their indices in the whole wire. */
struct NodeRange
{
  int begin = 0;
  int end = 0;

  bool empty() const { return begin >= end; }
  bool contains(int node) const { return node >= begin && node < end; }
  /** Extends the range to the smallest one that contains both. */
  void add(const NodeRange& other);
  void archive(Archive& archive);
};

/** Relation between the node indices of two samplings of a wire. Where the distal parts have the same nodes, their
 *  indices differ by a constant; otherwise nothing known per node is valid in the new sampling. */
class NodeRenumbering
{
public:
  /** @param first_node first node, in @p from, of the part that must be the same */
  NodeRenumbering(const Discretisation& from, const Discretisation& to, int first_node);

  bool isShift() const { return is_shift_; }
  int shift() const { return shift_; }  ///< number of nodes added before the common part

  /** Shifts values per node, or clears them. New nodes get the value of the first old one. */
  void apply(std::vector<double>& of_nodes) const;
  /** Shifts a range of nodes, or empties it. */
  void apply(NodeRange& range) const;

private:
  int shift_;
  bool is_shift_;
};

}  // namespace endovascular_sim::rod
