#pragma once

#include <cstddef>
#include <limits>
#include <optional>
#include <utility>
#include <vector>

#include <Eigen/Core>

#include "geometry/kd_tree.h"
#include "geometry/polyline.h"
#include "vessel/model/vessel.h"

namespace endovascular_sim
{
class Archive;
}

namespace endovascular_sim::intervention
{

/** How a wall yields to a balloon. All values are assumed: typical of what is reported for coronary lesions, which
 *  open between 2 and 8 atm, calcified ones later or not at all. */
struct OpeningLaw
{
  double first_pressure = 2.0265e5;  ///< at which the wall begins to yield: 2 atm [Pa]
  double full_pressure = 8.106e5;    ///< at which nothing of it holds the balloon back: 8 atm [Pa]
  /** Share of the diameter that is lost again when a balloon goes, without a stent [1]. */
  double recoil = 0.10;
  double risky_stretch = 1.3;  ///< diameter against the healthy vessel's beyond which it may tear [1]
};

/** A round body in the vessel: the axis of the shaft with a radius at each of its points. */
struct RoundBody
{
  std::vector<Eigen::Vector3d> axis;  ///< [m], two points or more
  std::vector<double> radii;          ///< [m], one per point; 0 where there is no body
};

/** What the wall is told of one step: all that the vessel needs to know of an instrument. */
struct BalloonLoad
{
  RoundBody balloon;                ///< with a stent that is still on it; empty where nothing is in the vessel
  double pressure = 0.0;            ///< [Pa]; not positive: the balloon presses no longer
  std::optional<RoundBody> sleeve;  ///< of a stent that was placed in this step and holds the wall from now on
};

/** Saves or loads them. */
void archive(Archive& archive, RoundBody& body);
void archive(Archive& archive, BalloonLoad& pressing);

/** Vertices of the vessel's mesh that have moved, and where they are now. */
struct WallDisplacement
{
  std::vector<int> indices;
  std::vector<Eigen::Vector3d> positions;  ///< [m]
};

void archive(Archive& archive, WallDisplacement& displacement);

/** The wall yields to balloons and stents (docs/INTERVENTION.md).
 *
 *  A vertex that a body of radius r reaches moves straight away from the body's axis: from its distance r₀ to
 *  r₀ + share·(r − r₀), where the share rises from 0 at the law's first pressure to 1 at its full one and does not
 *  fall again (a plaque that has cracked stays so). When the body shrinks, the wall follows, down to the larger of r₀
 *  and (1 − recoil) times the largest distance it had. Within a stent it stays outside of the stent. Distances are
 *  measured from where the wall stood when the body was last empty, so the answer does not depend on how often one
 *  asks. */
class VesselOpening
{
public:
  /** @param vessel with its centreline; its healthy radii tell how far the wall is stretched */
  VesselOpening(const vessel::Vessel& vessel, const OpeningLaw& law);

  VesselOpening(const VesselOpening&) = delete;
  VesselOpening& operator=(const VesselOpening&) = delete;

  /** A balloon presses, or, at no pressure, presses no longer.
   *  @param pressure [Pa]
   *  @param most vertices to move in this call: the others follow in the next ones, in turn, so that contact never has
   *         much to do at once
   *  @return the vertices that moved by more than a micrometre since they were last returned; valid until the next
   *          call */
  const WallDisplacement& press(const RoundBody& balloon, double pressure,
                                std::size_t most = std::numeric_limits<std::size_t>::max());

  /** The same of all that an instrument does to the wall in a step. */
  const WallDisplacement& press(const BalloonLoad& pressing,
                                std::size_t most = std::numeric_limits<std::size_t>::max());

  /** From now on the wall is at no place narrower than this sleeve. Moved vertices come with the next press(). */
  void hold(const RoundBody& sleeve);

  /** The largest diameter anywhere so far against that of the healthy vessel there [1]; 1 where it was not widened. */
  double largestStretch() const { return largest_stretch_; }
  bool atRisk() const { return largest_stretch_ > law_.risky_stretch; }

  const geometry::TriangleMesh& mesh() const { return mesh_; }  ///< as it is now

  const std::vector<Eigen::Vector3d>& firstVertices() const { return first_; }  ///< of the mesh at the beginning [m]

  /** Saves or loads all that changes. */
  void archive(Archive& archive);

private:
  /** What a vertex has been through. */
  struct Wall
  {
    Eigen::Vector3d base;                            ///< where it stood when the balloon was last empty [m]
    double peak = 0.0;                               ///< largest distance from a balloon's axis since [m]
    Eigen::Vector3d rest = Eigen::Vector3d::Zero();  ///< from the base to where it stays without a balloon [m]
    Eigen::Vector3d held = Eigen::Vector3d::Zero();  ///< from the base to a stent's surface, if that is outside [m]
    bool active = false;                             ///< stands elsewhere than where it would stay
    double healthy_radius = 0.0;                     ///< of the vessel there [m]; 0 without a centreline
  };

  /** A vertex seen from a body's axis. */
  struct Reach
  {
    double distance = 0.0;                              ///< [m]
    double radius = 0.0;                                ///< of the body there [m]
    Eigen::Vector3d outward = Eigen::Vector3d::Zero();  ///< unit
  };

  /** Order of vertices along a body: its segment, and the index. */
  using Place = std::pair<std::size_t, int>;
  Place placeOf(int vertex) const { return {segment_of_[static_cast<std::size_t>(vertex)], vertex}; }

  Reach reachOf(const geometry::Polyline& axis, const std::vector<double>& radii, int vertex) const;
  void findNear(const geometry::Polyline& axis, double widest);
  bool settle(int vertex, const Eigen::Vector3d& position, std::size_t most);
  void startAnew();

  OpeningLaw law_;
  geometry::TriangleMesh mesh_;
  std::vector<Eigen::Vector3d> first_;    ///< vertices at the beginning: what the tree holds [m]
  std::vector<Eigen::Vector3d> normals_;  ///< at the vertices at the beginning, out of the lumen
  geometry::PointTree tree_;
  std::vector<Wall> walls_;
  std::vector<int> near_, active_;
  std::vector<std::size_t> segment_of_;  ///< of a body's axis, per vertex in near_
  Place next_;                           ///< with which the next call begins
  bool empty_ = true;                    ///< the balloon
  std::vector<char> marked_;
  double farthest_ = 0.0;       ///< of any vertex from where it was at the beginning [m]
  double peak_pressure_ = 0.0;  ///< since the balloon was last empty [Pa]
  double largest_stretch_ = 1.0;
  WallDisplacement moved_;
};

}  // namespace endovascular_sim::intervention
