#pragma once

#include <cstdint>
#include <limits>
#include <unordered_map>
#include <vector>

#include <Eigen/Core>

#include "contact/bvh.h"
#include "contact/contact_set.h"
#include "contact/wall.h"

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
 *  only where its globally nearest feature says so. Which triangles are near is asked of the tree once per cube of
 *  space that the wire visits, and each node and edge keeps the few of them that it can meet while it stays where it
 *  is; what is found depends on neither, so a detector that was restarted gives the same bits. */
class Detector : public ContactSource
{
public:
  /** @param mesh watertight, oriented
   *  @param vessel_version goes into every set */
  Detector(const vessel::TriangleMesh& mesh, WallLaw law, std::uint64_t vessel_version = 1);

  void detect(const Query& query, ContactSet& set) override;

  /** Signed distance from a point to the wall, positive inside the lumen [m]. */
  double signedDistance(const Eigen::Vector3d& point) const;

  const Wall& wall() const { return wall_; }

private:
  using CellKey = std::uint64_t;

  /** What a node or an edge's middle anywhere in one cube of space may meet. */
  struct Cell
  {
    double clear = 0.0;             ///< no wall within this of any point of the cube [m]
    std::vector<int> triangles;     ///< all within a node's reach of the cube, ascending
    std::vector<int> reflex_edges;  ///< all within an edge's reach of the cube, ascending
  };

  /** What a node or an edge of the wire may meet while its ends stay within `room` of where they were. */
  struct Neighbourhood
  {
    Eigen::Vector3d begin = Eigen::Vector3d::Zero();
    Eigen::Vector3d end = Eigen::Vector3d::Zero();
    double room = -1.0;   ///< [m]; negative: not listed yet
    double limit = -1.0;  ///< distance up to which features are wanted [m]
    std::vector<int> items;

    bool holds(const Eigen::Vector3d& a, const Eigen::Vector3d& b, double wanted) const;
    void start(const Eigen::Vector3d& a, const Eigen::Vector3d& b, double wanted);
  };

  /** A mesh edge as its smallest ball with its direction. */
  struct EdgeBall
  {
    Eigen::Vector3d middle;
    Eigen::Vector3d direction;  ///< unit
    Eigen::Vector3d normal;     ///< towards the lumen, ⟂ direction, unit
    double half_length;         ///< [m]
  };

  void setReach(const Query& query);
  const Cell& cellAt(const Eigen::Vector3d& point);
  void makeCell(const Eigen::Vector3d& centre);
  const Neighbourhood& triangleNeighbourhood(int node, const Eigen::Vector3d& point, double limit);
  const Neighbourhood& edgeNeighbourhood(int edge, const Eigen::Vector3d& a, const Eigen::Vector3d& b, double limit);
  void detectNode(const Query& query, std::size_t index, std::vector<Feature>& features);
  bool faceFeature(const Eigen::Vector3d& point, int triangle, double limit, Feature& feature, double& distance,
                   bool& outside) const;
  void detectEdge(const Query& query, std::size_t index, std::vector<Feature>& features);
  bool canMeet(const Eigen::Vector3d& a, const Eigen::Vector3d& b, int wall_edge, double reach, double limit) const;
  bool crossing(const Eigen::Vector3d& a, const Eigen::Vector3d& b, int wall_edge, double limit, Feature& feature,
                double& distance) const;
  bool vertexIsMinimum(int vertex, const Eigen::Vector3d& offset) const;
  void appendDistinct(std::vector<Feature>& features, std::size_t first, const Feature& feature) const;
  double clearanceRadius(const Query& query, const Feature& feature) const;
  void freeDistances(const Query& query, ContactSet& set);

  Wall wall_;
  Bvh bvh_;
  WallLaw law_;
  std::uint64_t vessel_version_;
  double node_reach_ = 0.0;  ///< from a node's axis to the farthest feature that is looked for [m]
  double edge_reach_ = 0.0;  ///< the same from an edge's middle [m]
  std::unordered_map<CellKey, int> cell_of_key_;
  std::vector<Cell> cells_;
  std::vector<Neighbourhood> near_nodes_, near_edges_;  ///< by index from the tip
  std::vector<int> nearest_;                            ///< triangle that was nearest to each node, or −1
  std::vector<int> collected_;
  std::vector<EdgeBall> edge_balls_;
  std::vector<char> edge_marked_;
};

}  // namespace endovascular_sim::contact
