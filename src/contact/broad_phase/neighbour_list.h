#pragma once

#include <limits>
#include <vector>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "contact/broad_phase/bvh.h"
#include "contact/broad_phase/edge_packet.h"
#include "contact/broad_phase/triangle_packet.h"
#include "contact/narrow_phase/wall_bounds.h"

namespace endovascular_sim::contact
{

/** Verlet list of one node of the wire and the edge behind it: the triangles and reflex edges of the wall within the
 *  cutoff plus a skin.
 *
 *  The list holds for every position of the node in a short interval along the wire, so that a sliding wire keeps it.
 *  It stays valid while wire and wall have moved by less than the skin, and while the cutoff changes little. Contents
 *  are a superset of the features that the narrow phase accepts: contacts do not depend on when the list was built. */
class NeighbourList
{
public:
  /** Memory for rebuild, reused between lists. */
  struct Scratch
  {
    std::vector<int> triangles, owners;
  };

  /** Reserves memory for lists of usual length. */
  void reserve();

  /** Measures the displacement since the list was built and updates its validity.
   *  @param a, b positions of the node and the next one [m]
   *  @param cutoff distance from the axis up to which features are needed now [m] */
  void follow(const Eigen::Vector3d& a, const Eigen::Vector3d& b, double cutoff);

  /** Whether the list contains everything within the cutoff of the positions given to follow, apart from changes of the
   *  wall's shape. */
  bool isValid() const { return valid_; }

  /** Queries until the list becomes invalid if the displacement grows as in the last one; infinite without growth. */
  double queriesLeft() const;

  /** Rebuilds an invalid list; renews the packets of a valid one whose features have moved.
   *  @param a, b, cutoff as for follow */
  void update(const Bvh& bvh, const WallBounds& bounds, const Eigen::Vector3d& a, const Eigen::Vector3d& b,
              double cutoff, Scratch& scratch);

  /** Rebuilds a list, also a valid one. @param a, b, cutoff as for follow */
  void renew(const Bvh& bvh, const WallBounds& bounds, const Eigen::Vector3d& a, const Eigen::Vector3d& b,
             double cutoff, Scratch& scratch);

  /** A movement of the wall. */
  struct WallMovement
  {
    Eigen::AlignedBox3d bounds;         ///< contains the changed triangles before and after [m]
    double largest_displacement = 0.0;  ///< of a vertex [m]
    bool first = false;                 ///< whether a triangle moved that had never moved before
    std::vector<int> new_reflex;        ///< edges that have become reflex
  };
  /** Accounts for a movement of the wall. Features that move for the first time may have been omitted because of their
   *  orientation, so they use up the whole skin. Edges that are no longer reflex remain in the list without effect. */
  void followWall(const WallMovement& movement);

  bool hasTriangles() const { return !triangles_.empty(); }
  bool hasEdges() const { return !edges_.empty(); }

  /** Visits, in ascending order, the triangles on which the closest point to a point may be a local minimum of the
   *  distance within the cutoff. The list must be up to date. */
  template <class Visit>
  void forEachTriangle(const Eigen::Vector3d& point, double cutoff, Visit&& visit) const
  {
    forEachCandidate(triangle_packets_, TriangleLanes::Probe(point, begin_, cutoff, displacement_), visit);
  }

  /** Visits, in ascending order, the reflex edges that an edge of the wire may touch between its nodes within the
   *  cutoff. The list must be up to date. @param taper radius at @p b minus radius at @p a [m] */
  template <class Visit>
  void forEachEdge(const Eigen::Vector3d& a, const Eigen::Vector3d& b, double taper, double cutoff, Visit&& visit) const
  {
    forEachCandidate(edge_packets_, EdgeLanes::Probe(a, b, taper, begin_, cutoff, displacement_), visit);
  }

private:
  /** A triangle or mesh edge in the list. */
  struct Entry
  {
    int index;
    float clearance;  ///< displacement of wire and wall below which the feature cannot be a contact [m]
  };

  void start(const Eigen::Vector3d& a, const Eigen::Vector3d& b, double cutoff);
  void rebuild(const Bvh& bvh, const WallBounds& bounds, Scratch& scratch);
  void pack(const WallBounds& bounds);
  double squaredDistanceTo(const Eigen::Vector3d& point, double farthest) const;

  Eigen::Vector3d begin_ = Eigen::Vector3d::Zero();     ///< begin of the segment in which the edge may lie [m]
  Eigen::Vector3d along_ = Eigen::Vector3d::Zero();     ///< direction of the segment, unit; zero for a point
  Eigen::Vector3d built_at_ = Eigen::Vector3d::Zero();  ///< position of the node at the last rebuild [m]
  double length_ = 0.0;                                 ///< length of the segment [m]
  double slide_ = 0.0;              ///< length of the interval at the segment's begin in which the node may lie [m]
  double cutoff_ = -1.0;            ///< [m]; negative: never built
  double skin_ = 0.0;               ///< displacement up to which the list is complete [m]
  double displacement_ = 0.0;       ///< bound of the wire's and the wall's displacement since the last rebuild [m]
  double wall_displacement_ = 0.0;  ///< the wall's share of it [m]
  double growth_ = 0.0;             ///< of displacement_ in the last query [m]
  std::vector<Entry> triangles_;    ///< ascending
  std::vector<Entry> edges_;        ///< ascending; reflex edges
  std::vector<TrianglePacket> triangle_packets_;  ///< of triangles_, relative to begin_
  std::vector<EdgePacket> edge_packets_;          ///< of edges_
  bool valid_ = false;
  bool packets_outdated_ = false;  ///< whether listed features have moved since they were packed
  bool was_long_ = false;          ///< whether the last list was long
};

}  // namespace endovascular_sim::contact
