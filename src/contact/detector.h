#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>
#include <vector>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "common/helper_thread.h"
#include "contact/broad_phase/bvh.h"
#include "contact/broad_phase/edge_packet.h"
#include "contact/broad_phase/triangle_packet.h"
#include "contact/contract/contact_set.h"
#include "contact/narrow_phase/edge_bounds.h"
#include "contact/narrow_phase/triangle_slab.h"
#include "contact/wall/wall.h"
#include "geometry/closest_points_on_segments.h"

namespace endovascular_sim::contact
{

/** The wall's mechanical law. */
struct WallLaw
{
  double stiffness = std::numeric_limits<double>::infinity();  ///< per length of wire [N/m²]; infinite: rigid
  double friction = 0.0;                                       ///< Coulomb coefficient outside all regions

  /** A ball with a coefficient of its own. */
  struct FrictionRegion
  {
    Eigen::Vector3d centre = Eigen::Vector3d::Zero();  ///< [m]
    double radius = 0.0;                               ///< [m]
    double friction = 0.0;                             ///< Coulomb coefficient
  };
  std::vector<FrictionRegion> regions;

  /** Coefficient at a place of the wall: that of the last region which holds it. */
  double frictionAt(const Eigen::Vector3d& place) const;
};

/** Finds the features of the wall near a wire: exact local minima of the distance between the wire's axis and the
 *  wall (docs/CONTACT.md).
 *
 *  Per node: closest points on the triangles around it that are true local minima (normal-cone test on reflex edges
 *  and vertices), all distinct normals. Per edge: crossing reflex edges and vertices of the mesh. A point is outside
 *  only where its globally nearest feature says so. Each node and edge keeps the few triangles and ridges that it can
 *  meet while it stays about where it is or slides along itself; what is found does not depend on that, so a restarted
 *  detector gives the same bits. */
class Detector : public ContactSource
{
public:
  /** @param mesh watertight, oriented
   *  @param vessel_version goes into every set */
  Detector(const geometry::TriangleMesh& mesh, WallLaw law, std::uint64_t vessel_version = 1);

  void detect(const Query& query, ContactSet& set) override;
  void freeDistances(const Query& query, double wanted, ContactSet& set) override;

  /** Shares long searches (filled balloons) and movements of the wall with another thread from now on; answers stay the
   * same bits.
   *  @param helper must outlive the detector; null: none */
  void setHelper(HelperThread* helper) { helper_ = helper; }

  /** Lets the wall follow a vessel whose vertices have moved, in a time that grows with what is near them only. Answers
   *  are afterwards, bit for bit, those of a detector made from the moved mesh.
   *  @param indices distinct vertices of the mesh
   *  @param positions [m], as many
   *  @param vessel_version goes into every set from now on */
  void moveVertices(const std::vector<int>& indices, const std::vector<Eigen::Vector3d>& positions,
                    std::uint64_t vessel_version);

  /** Signed distance from a point to the wall, positive inside the lumen [m].
   *  @param near a triangle that is expected to be near, or −1; the answer does not depend on it
   *  @param nearest gets the triangle that is nearest, unless it is null */
  double signedDistance(const Eigen::Vector3d& point, int near = -1, int* nearest = nullptr) const;

  const Wall& wall() const { return wall_; }

  /** Nodes for which what is near had to be listed anew, ever: what the wire's motion costs. */
  std::uint64_t listsRenewed() const { return lists_renewed_; }

private:
  /** A triangle or mesh edge, and by how much wire and wall have to come closer before it can be met. */
  struct Near
  {
    int index;
    float clear;  ///< [m]
  };

  /** What a node of the wire and the edge from it to the next node may meet: of all places that they have while the
   * wire slides along itself a little, and until wire and wall have come closer by more than the lists have room for.
   */
  struct NeighbourList
  {
    /** m of which half is listed beyond the distance that is wanted, where that changes (a balloon's does). */
    static constexpr double kLimitSlack = 0.1e-3;
    /** m by which what is wanted may fall short of what was listed: more than a wire that moved fast, and does no more,
     * was asked about beyond it. */
    static constexpr double kLimitKept = 0.6e-3;

    Eigen::Vector3d begin = Eigen::Vector3d::Zero();      ///< of the segment on which the edge may lie
    Eigen::Vector3d along = Eigen::Vector3d::Zero();      ///< its direction, unit; 0 for a point
    Eigen::Vector3d listed_at = Eigen::Vector3d::Zero();  ///< where the node was then
    double length = 0.0;                                  ///< of the segment [m]
    double reach = 0.0;                                   ///< of it from its begin: where the node may lie [m]
    double limit = -1.0;                 ///< distance up to which features are wanted [m]; negative: not listed yet
    double room = 0.0;                   ///< by which wire and wall may come closer and the lists still hold [m]
    double moved = 0.0;                  ///< by which wire and wall have come closer since, at most [m]
    double wall_moved = 0.0;             ///< the wall's share of it [m]
    std::vector<Near> triangles;         ///< that the node may meet, ascending
    std::vector<Near> edges;             ///< reflex ones that the wire's edge may meet, ascending
    std::vector<TrianglePacket> prisms;  ///< of the triangles, as seen from begin
    std::vector<EdgePacket> ridges;      ///< of the edges
    bool holds = false;                  ///< whether the lists hold all that the wire may meet where it is now
    bool wall_differs = false;           ///< from what they hold
    bool was_long = false;               ///< when they were made

    /** Notes how far the wire is, and whether the lists still hold all that it may meet. */
    void follow(const Eigen::Vector3d& a, const Eigen::Vector3d& b, double wanted);
    /** Whether the wire is about where it was listed, hardly moved or by much less than an edge; else its lists may be
     * another node's. */
    bool isHere() const { return limit >= 0.0 && moved < std::max(1.5 * room, 0.25 * length); }
    /** Whether there is nothing to make anew. */
    bool isUpToDate() const { return holds && !wall_differs; }
    /** Has nothing listed any more. */
    void forget();
    /** Has nothing listed, but knows of the last lists what new ones depend on. */
    void comeAfter(const NeighbourList& last);
    /** How far a node has come along the wire since it was where the lists begin [m]. */
    double past(const Eigen::Vector3d& node) const { return (node - begin).dot(along); }
    void start(const Eigen::Vector3d& a, const Eigen::Vector3d& b, double wanted);
    double squaredDistanceTo(const Eigen::Vector3d& point, double farthest) const;
    Eigen::Vector3d end() const { return begin + length * along; }
  };

  /** What nodes that slid on have left where they were: lists of places between a node and the one behind it, in their
   * order along the wire. */
  class Trail
  {
  public:
    /** Of the trail's two ends, the one at the node that it is behind. */
    enum class End
    {
      kRear,
      kFront,
    };

    bool empty() const { return count_ == 0; }
    NeighbourList& at(End end) { return ring_[end == End::kRear ? first_ : (first_ + count_ - 1) % ring_.size()]; }
    void drop(End end);
    /** A place at an end to leave lists in; where there is no room, the other end's are lost. */
    NeighbourList& extend(End end);
    void clear() { count_ = 0; }

  private:
    std::array<NeighbourList, 8> ring_;
    std::size_t first_ = 0;
    std::size_t count_ = 0;
  };

  /** Triangles that something was listed from. */
  struct Collected
  {
    std::vector<int> triangles, ridged;
  };

  /** Nodes, the edges behind them, and what is found there. */
  struct Part
  {
    std::size_t begin = 0;
    std::size_t end = 0;
    Collected collected;
    std::vector<Feature> of_nodes, of_edges;
  };

  /** An edge of the wire, or what lists are made for. */
  struct AxisSegment
  {
    AxisSegment(const Eigen::Vector3d& from, const Eigen::Vector3d& to);

    Eigen::Vector3d begin, end, along;  ///< along: end − begin
    double inverse_square = 0.0;        ///< of its length [1/m²]; 0 for a point
  };

  /** Index by which a node or edge is remembered: from the tip, so that nodes that come and go at the wire's other end
   * change nothing. */
  static int placeFromTip(const Query& query, std::size_t index)
  {
    return static_cast<int>(query.nodes.size() - 1 - index);
  }
  /** The other end of the edge behind a node; the tip has none. */
  static std::size_t nextNode(const Query& query, std::size_t index)
  {
    return std::min(index + 1, query.nodes.size() - 1);
  }
  /** Distance from a node up to which features are wanted [m]. */
  static double limitAt(const Query& query, std::size_t index) { return query.radius[index] + query.margin[index]; }
  /** Of a node and the edge behind it. */
  static double listedLimit(const Query& query, std::size_t index)
  {
    return std::max(limitAt(query, index), limitAt(query, nextNode(query, index)));
  }
  const NeighbourList& neighbourhood(const Query& query, std::size_t index) const
  {
    return near_[placeFromTip(query, index)];
  }
  void followWire(const Query& query);
  static void followNode(const Query& query, std::size_t index, NeighbourList& near);
  void handOver(const Query& query);
  void slideOn(const Query& query, std::size_t place);
  static bool takeOver(const Query& query, std::size_t index, Trail& trail, Trail::End end, NeighbourList& near);
  void renewLists(const Query& query);
  void renewList(const Query& query, std::size_t index, Collected& collected);
  void list(NeighbourList& near, Collected& collected) const;
  void pack(NeighbourList& near) const;
  void listTriangle(int triangle, NeighbourList& near) const;
  void listEdge(int wall_edge, bool has_moved, const AxisSegment& segment, NeighbourList& near) const;
  static double coneClearance(double low, double high, double beside, double slope, double limit);
  static double ridgeClearance(const EdgeBounds& ball, const AxisSegment& segment, double limit);
  bool cutIntoParts(const Query& query);
  void detectParts(const Query& query, std::vector<Feature>& features);
  void detectNode(const Query& query, std::size_t index, std::vector<Feature>& features) const;
  void detectEdge(const Query& query, std::size_t index, std::vector<Feature>& features) const;
  void addLaw(const Query& query, std::vector<Feature>& features) const;
  void makePrism(int triangle);
  void setSlopes(int triangle, TriangleSlab& prism) const;
  bool foldsAt(int vertex, int triangle) const;
  Bvh::Cone coneOf(int triangle) const;
  EdgeBounds ballOf(const WallEdge& edge) const;
  double leanOf(const WallEdge& edge) const;
  void renewEdges(const std::vector<int>& changed);
  void renewPrisms(const std::vector<int>& changed);
  void keepUp(const Eigen::AlignedBox3d& moved, double farthest, bool anew);
  double nearestListed(const NeighbourList& near, const Eigen::Vector3d& point, double limit) const;
  bool faceFeature(const Eigen::Vector3d& point, int triangle, double limit, Feature& feature, double& distance,
                   bool& outside) const;
  Eigen::Vector3d placeOnEdge(const Eigen::Vector3d& point, int wall_edge) const;
  bool mayContact(const AxisSegment& segment, int wall_edge, double limit) const;
  bool crossing(const Eigen::Vector3d& a, const Eigen::Vector3d& b, const std::optional<geometry::TaperedSegment>& cone,
                int wall_edge, double limit, Feature& feature, double& distance) const;
  bool vertexIsMinimum(int vertex, const Eigen::Vector3d& offset) const;
  void appendDistinct(std::vector<Feature>& features, std::size_t first, const Feature& feature) const;
  double clearanceRadius(const Query& query, const Feature& feature) const;
  double wallDistance(const Query& query, std::size_t index, double farthest);
  void begin(const Query& query, ContactSet& set);

  Wall wall_;
  Bvh bvh_;
  WallLaw law_;
  std::uint64_t vessel_version_;
  std::vector<NeighbourList> near_;  ///< by the node's index from the tip
  std::vector<NeighbourList> left_;  ///< while they are handed over; else nothing is listed in them
  std::vector<Trail> trails_;        ///< before each node and behind the last, by their indices from the tip
  std::uint64_t lists_renewed_ = 0;
  std::vector<int> nearest_;  ///< triangle that was nearest to each node, or −1
  Collected collected_;
  HelperThread* helper_ = nullptr;
  std::vector<Part> parts_;
  std::vector<int> now_reflex_, now_moving_;
  std::vector<TriangleSlab> prisms_;
  std::vector<EdgeBounds> edge_balls_;
};

}  // namespace endovascular_sim::contact
