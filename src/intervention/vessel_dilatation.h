#pragma once

#include <cstddef>
#include <limits>
#include <utility>
#include <vector>

#include <Eigen/Core>

#include "geometry/kd_tree.h"
#include "geometry/polyline.h"
#include "intervention/balloon_load.h"
#include "intervention/wall_displacement.h"
#include "vessel/model/vessel.h"

namespace endovascular_sim
{
class Archive;
}

namespace endovascular_sim::intervention
{

/** Dilatation law: response of the wall to a balloon. All values are assumed, typical of coronary lesions, which open
 *  between 2 and 8 atm. Calcified lesions open later or not at all. */
struct DilatationLaw
{
  double onset_pressure = 2.0265e5;  ///< pressure at which the wall begins to yield: 2 atm [Pa]
  double full_pressure = 8.106e5;    ///< pressure at which the balloon reaches its unconstrained size: 8 atm [Pa]
  double recoil = 0.10;              ///< elastic recoil: relative loss of diameter at deflation without a stent [1]
  double critical_stretch = 1.3;     ///< ratio to the healthy diameter beyond which the wall may tear [1]
};

/** Kinematic model of balloon dilatation and stenting of the wall (docs/INTERVENTION.md).
 *
 *  A vertex at distance r₀ from the axis of a body of radius r > r₀ moves radially to the distance r₀ + s·(r − r₀). The
 *  yield fraction s rises linearly from 0 at the onset pressure to 1 at the full pressure. It never decreases, because
 *  fractured plaque does not heal. When the body shrinks, the wall recoils to the larger of r₀ and (1 − recoil) times
 *  its peak distance. Within a stent the wall stays outside of the stent. Distances r₀ refer to the positions when the
 *  balloon was last empty, so the result does not depend on the number of calls. */
class VesselDilatation
{
public:
  /** @param vessel vessel with its centreline, whose healthy radii are the reference of the stretch */
  VesselDilatation(const vessel::Vessel& vessel, const DilatationLaw& law);

  VesselDilatation(const VesselDilatation&) = delete;
  VesselDilatation& operator=(const VesselDilatation&) = delete;

  /** Applies a balloon, or removes it if the pressure is not positive.
   *  @param balloon unconstrained shape of the balloon
   *  @param pressure transmural pressure [Pa]
   *  @param max_vertices largest number of vertices to move; the others follow in the next calls. It bounds the cost of
   *         the update of contact detection.
   *  @return vertices that moved by more than 1 µm since they were last returned; valid until the next call */
  const WallDisplacement& applyLoad(const RoundBody& balloon, double pressure,
                                    std::size_t max_vertices = std::numeric_limits<std::size_t>::max());

  /** Applies the balloon and the placed stent of a load. */
  const WallDisplacement& applyLoad(const BalloonLoad& load,
                                    std::size_t max_vertices = std::numeric_limits<std::size_t>::max());

  /** Places a stent: the wall stays outside of the sleeve. The next applyLoad() returns the moved vertices. */
  void placeSleeve(const RoundBody& sleeve);

  /** Largest ratio so far of a vertex's diameter to the local healthy diameter [1]; 1 without dilatation. */
  double largestStretch() const { return largest_stretch_; }
  bool atRisk() const { return largest_stretch_ > law_.critical_stretch; }

  const geometry::TriangleMesh& mesh() const { return mesh_; }  ///< deformed mesh

  const std::vector<Eigen::Vector3d>& initialVertices() const { return initial_vertices_; }  ///< undeformed mesh [m]

  /** Saves or loads the state. */
  void archive(Archive& archive);

private:
  /** Deformation state of a vertex. */
  struct VertexState
  {
    Eigen::Vector3d base;                            ///< position when the balloon was last empty [m]
    double peak = 0.0;                               ///< largest distance from a balloon's axis since then [m]
    Eigen::Vector3d rest = Eigen::Vector3d::Zero();  ///< displacement from the base after recoil [m]
    Eigen::Vector3d held = Eigen::Vector3d::Zero();  ///< displacement from the base to the surface of a stent [m]
    bool active = false;                             ///< true while the vertex may have to move
    double healthy_radius = 0.0;                     ///< local radius of the healthy vessel [m]; 0 without a centreline
  };

  /** Position of a vertex relative to a body's axis. */
  struct Reach
  {
    double distance = 0.0;                              ///< distance from the axis [m]
    double radius = 0.0;                                ///< radius of the body at the foot point [m]
    Eigen::Vector3d outward = Eigen::Vector3d::Zero();  ///< unit vector from the axis to the vertex
  };

  /** Sort key of a vertex along a body: segment of the axis, then vertex index. */
  using Order = std::pair<std::size_t, int>;
  Order orderOf(int vertex) const { return {segment_of_[static_cast<std::size_t>(vertex)], vertex}; }

  /** Body whose surroundings near_ holds. They are followed: another body near it needs no search. */
  struct Surroundings
  {
    std::vector<Eigen::Vector3d> axis;  ///< [m]; empty before the first search
    double widest = 0.0;                ///< largest radius [m]
    double displacement = 0.0;          ///< largest displacement of a vertex [m]
  };

  Reach reachOf(const geometry::Polyline& axis, const std::vector<double>& radii, int vertex) const;
  void follow(const geometry::Polyline& axis, double widest);
  bool isFollowed(const std::vector<Eigen::Vector3d>& axis, double widest) const;
  void findNear();
  bool moveVertex(int vertex, const Eigen::Vector3d& position, std::size_t max_vertices);
  void resetBase();
  void deflate(std::size_t max_vertices);
  double dilate(int vertex, const Reach& reach, double yield_fraction);

  DilatationLaw law_;
  geometry::TriangleMesh mesh_;
  std::vector<Eigen::Vector3d> initial_vertices_;  ///< undeformed vertices, referenced by the tree [m]
  std::vector<Eigen::Vector3d> normals_;           ///< outward unit normals of the undeformed mesh, per vertex
  geometry::KdTree tree_;
  std::vector<VertexState> vertices_;
  Surroundings surroundings_;
  std::vector<int> near_, active_;
  std::vector<std::size_t> segment_of_;  ///< segment of the body's axis, per vertex in near_
  Order next_;                           ///< first vertex of the next call
  bool empty_ = true;                    ///< true while the balloon is empty
  std::vector<char> marked_;
  double largest_displacement_ = 0.0;  ///< of any vertex from its undeformed position [m]
  double peak_pressure_ = 0.0;         ///< largest pressure since the balloon was last empty [Pa]
  double largest_stretch_ = 1.0;
  WallDisplacement displacement_;  ///< result of the last call
};

}  // namespace endovascular_sim::intervention
