#pragma once

#include <cstdint>
#include <limits>
#include <vector>

#include <Eigen/Core>

namespace endovascular_sim::contact
{

/** A feature of the wall near one edge of the rod: geometry, not force. Edge j joins nodes j and j+1. The members stand
 *  in the order of ContactFeature.msg, so that a set is serialized as one block. */
struct Feature
{
  int edge = 0;                                      ///< index in the whole wire
  int triangle = 0;                                  ///< triangle that owns the feature
  double parameter = 0.0;                            ///< position on the edge, 0 at node j, 1 at node j+1
  Eigen::Vector3d point = Eigen::Vector3d::Zero();   ///< closest point of the wall [m]
  Eigen::Vector3d normal = Eigen::Vector3d::Zero();  ///< unit normal, towards the lumen
  double gap = 0.0;                                  ///< wire's surface to wall, negative beyond the wall [m]
  double clearance_radius =
      std::numeric_limits<double>::infinity();  ///< wall's radius of curvature across the wire − wire radius [m]
  double stiffness = std::numeric_limits<double>::infinity();  ///< wall's stiffness per length of wire [N/m²]
  double friction = 0.0;                                       ///< Coulomb coefficient
  std::int64_t id = 0;  ///< 3·index + kind (0 face, 1 edge, 2 vertex of the mesh)
};

/** State of the rod for which contacts are queried: the centreline, the radii and one margin per node. Between two
 *  nodes, radius and margin vary linearly. */
struct Query
{
  std::uint64_t step = 0;
  std::uint32_t substep = 0;
  std::uint32_t pass = 0;
  std::uint64_t vessel_version = 0;    ///< version of the wall that is searched; 0: the present one
  int first_node = 0;                  ///< index of nodes[0] in the whole wire
  std::vector<Eigen::Vector3d> nodes;  ///< proximal to distal [m]
  std::vector<double> radius;          ///< outer radius at each node [m]
  std::vector<double> margin;          ///< per node: features closer than this to the wire's surface are listed [m]
};

/** Wall features near the rod for one query: the contract between rod and contact. */
struct ContactSet
{
  std::uint64_t step = 0;
  std::uint32_t substep = 0;
  std::uint32_t pass = 0;
  std::uint64_t vessel_version = 0;
  bool stale = false;                 ///< an earlier answer, used because no answer to the query came in time
  int first_edge = 0;                 ///< index of the edge of free_distance[0] in the whole wire
  std::vector<double> free_distance;  ///< per edge: motion of any of its points that meets no unlisted feature [m]
  std::vector<Feature> features;
};

/** Value of StepReport::first_stale_pass where every pass of the step got a fresh contact set. */
constexpr std::uint32_t kNoStalePass = std::numeric_limits<std::uint32_t>::max();

/** Source of the rod solver's contact sets: the detector itself, or the contact node behind a topic. */
class ContactSource
{
public:
  virtual ~ContactSource() = default;

  /** Fills @p set with the features within the query's margins; the free distance of an edge is the lesser margin of
   *  its nodes. On a time-out, the features stay as they were and the set is marked stale. */
  virtual void detect(const Query& query, ContactSet& set) = 0;

  /** Fills @p set with free distances only. On a time-out, the set is marked stale.
   *  @param wanted free distance beyond which values need not be distinguished, above 0 [m] */
  virtual void freeDistances(const Query& query, double wanted, ContactSet& set) = 0;
};

}  // namespace endovascular_sim::contact
