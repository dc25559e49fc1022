#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

#include <Eigen/Core>

#include "contact/contract/contact_set.h"
#include "rod/model/state.h"

namespace endovascular_sim
{
class Archive;
}

namespace endovascular_sim::rod
{

using NodalMotion = std::vector<Eigen::Vector3d>;  ///< increment of every node in a solve [m]

/** A one-sided spring between the wall and a point of an edge. */
struct ContactSpring
{
  int node = 0;            ///< first node of the edge
  double weight0 = 0.0;    ///< weight of that node
  double weight1 = 0.0;    ///< weight of the next one
  double stiffness = 0.0;  ///< [N/m]
  double gap = 0.0;        ///< gap of the wall's law, with the wall offset [m]
  double force = 0.0;      ///< after an accepted solve [N]
  double reached = 0.0;    ///< gap at the point reached by the active-set search [m]
  double resisted = 0.0;   ///< stiffness · gap at that point, in the systems solved so far [N]
  bool active = false;

  /** Gap after a motion, to first order [m]. */
  double gapAfter(const Eigen::Vector3d& normal, const NodalMotion& motion) const
  {
    double change = weight0 * normal.dot(motion[node]);
    if (weight1 > 0.0)
      change += weight1 * normal.dot(motion[node + 1]);
    return gap + change;
  }

  void archive(Archive& archive);
};

/** Contacts of one state with the springs of the solves that start from it. */
struct ContactList
{
  contact::ContactSet set;
  std::vector<ContactSpring> springs;  ///< one per feature of the set, once prepared
  std::size_t retained = 0;            ///< number of features at the end that the detection did not find

  /** Number of features that the detection found, stiff layers included. */
  std::size_t detected() const { return set.features.size() - retained; }
};

/** True for a contact between two nodes; false at a node. */
inline bool isBetweenNodes(const contact::Feature& feature)
{
  return feature.parameter > 0.0 && feature.parameter < 1.0;
}

/** True for the same part of the wall within one edge's length along the wire. */
inline bool isSameContact(const contact::Feature& a, const contact::Feature& b)
{
  return a.id == b.id && std::abs(a.edge + a.parameter - b.edge - b.parameter) < 1.0;
}

/** Offset of a contact's gap after a resampling (State::wall_offset) [m]. */
inline double wallOffset(const State& state, const contact::Feature& feature)
{
  const int next = std::min(feature.edge + 1, static_cast<int>(state.wall_offset.size()) - 1);
  return (1.0 - feature.parameter) * state.wall_offset[feature.edge] + feature.parameter * state.wall_offset[next];
}

}  // namespace endovascular_sim::rod
