#pragma once

#include <algorithm>
#include <cstdint>
#include <limits>
#include <vector>

#include <Eigen/Core>

namespace endovascular_sim::contact
{

/** A feature of the wall near one edge of the rod: geometry, not force. Edge j joins nodes j and j+1. In the order of
 *  ContactFeature.msg, so that a set goes into a message as one block. */
struct Feature
{
  int edge = 0;                                      ///< index over the whole wire
  int triangle = 0;                                  ///< triangle that owns the feature
  double parameter = 0.0;                            ///< place on the edge, 0 at node j, 1 at node j+1
  Eigen::Vector3d point = Eigen::Vector3d::Zero();   ///< closest point of the wall [m]
  Eigen::Vector3d normal = Eigen::Vector3d::Zero();  ///< unit, towards the lumen
  double gap = 0.0;                                  ///< wire's surface to wall, negative beyond the wall [m]
  double clearance_radius =
      std::numeric_limits<double>::infinity();  ///< wall's radius of curvature across the wire − wire radius [m]
  double stiffness = std::numeric_limits<double>::infinity();  ///< of the wall per length of wire [N/m²]
  double friction = 0.0;                                       ///< Coulomb coefficient
  std::int64_t id = 0;  ///< 3·index + kind (0 face, 1 edge, 2 vertex of the mesh)
};

/** Share of the listing margin that a body of some radius gets: all of it up to a thin catheter, less then. A filled
 *  balloon has the whole wall round it within a wire's margin, and moves little. */
inline double marginShare(double radius)
{
  constexpr double kLeast = 0.25;   // more than a hand moves in a sub-step or a balloon grows
  constexpr double kWide = 0.9e-3;  // m
  if (radius <= kWide)
    return 1.0;
  const double share = kWide / radius;
  return std::max(kLeast, share * share * share * share);
}

/** Whether a body of some radius is wide: its margin is that of a Query's wide bodies if that is less. */
inline bool isWide(double radius)
{
  return marginShare(radius) < 0.5;
}

/** How far off a body's surface features are listed [m]. @param wide_margin of wide bodies at most [m] */
inline double listingMargin(double margin, double wide_margin, double radius)
{
  const double own = margin * marginShare(radius);
  return isWide(radius) ? std::min(own, wide_margin) : own;
}

/** What the rod asks of the detector: its centreline, and how far to look. */
struct Query
{
  std::uint64_t step = 0;
  std::uint32_t substep = 0;
  std::uint32_t pass = 0;
  /** Above 0, free distances up to this are asked for instead of features [m]; larger ones need not be told apart. */
  double wanted_free_distance = 0.0;
  std::uint64_t vessel_version = 0;  ///< of the wall that is to be searched; 0: whichever there is
  double margin = 0.0;               ///< features closer than this to the wire's surface are listed, see marginAt [m]
  double wide_margin = std::numeric_limits<double>::infinity();  ///< a wide body's is no larger [m]
  double fast_margin = 0.0;  ///< instead of the margin at nodes that move fast and are not wide, if larger [m]
  int fast_begin = 0;        ///< the first of those nodes, by its index in the whole wire
  int fast_end = 0;          ///< behind the last of them
  int first_node = 0;        ///< index of nodes[0] in the whole wire
  std::vector<Eigen::Vector3d> nodes;  ///< proximal to distal [m]
  std::vector<double> radius;          ///< at each node [m]

  /** What counts as near at one of the nodes, evenly between two of them [m]. */
  double marginAt(std::size_t node) const
  {
    const int index = first_node + static_cast<int>(node);
    const bool fast = index >= fast_begin && index < fast_end && !isWide(radius[node]);
    return listingMargin(fast ? std::max(margin, fast_margin) : margin, wide_margin, radius[node]);
  }
};

/** All wall features near the rod for one state of it (the contract between rod and contact). */
struct ContactSet
{
  std::uint64_t step = 0;
  std::uint32_t substep = 0;
  std::uint32_t pass = 0;
  std::uint64_t vessel_version = 0;
  bool stale = false;  ///< an older answer, used because the asked one did not come in time
  int first_edge = 0;  ///< the edge that free_distance[0] speaks of
  std::vector<double>
      free_distance;  ///< per edge: motion of any of its points that cannot meet an unlisted feature [m]
  std::vector<Feature> features;
};

/** "Every pass of the step got a fresh contact set." */
constexpr std::uint32_t kNoStalePass = std::numeric_limits<std::uint32_t>::max();

/** Where the rod's solver gets its contact sets from: the detector itself, or the contact node behind a topic. */
class ContactSource
{
public:
  virtual ~ContactSource() = default;

  /** Fills @p set for the query; on a time-out it leaves the features as they were and marks the set stale. */
  virtual void detect(const Query& query, ContactSet& set) = 0;
};

}  // namespace endovascular_sim::contact
