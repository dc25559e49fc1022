#pragma once

#include <cstdint>
#include <limits>
#include <vector>

#include <Eigen/Core>

#include "contact/bvh.h"
#include "contact/contact_set.h"
#include "contact/wall.h"

namespace endovascular_sim::contact
{

/** The wall's mechanical law, the same everywhere. */
struct WallLaw
{
  double stiffness = std::numeric_limits<double>::infinity();  ///< per length of wire [N/m²]; infinite: rigid
  double friction = 0.0;                                       ///< Coulomb coefficient
};

/** Finds the features of the wall near a wire: exact local minima of the distance between the wire's axis and the
 *  wall (docs/CONTACT.md).
 *
 *  Per node: closest points on the triangles around it that are true local minima (normal-cone test on reflex edges
 *  and vertices), all distinct normals. Per edge: crossing reflex edges and vertices of the mesh. A point is outside
 *  only where its globally nearest feature says so. Candidate lists are kept from call to call; what is found does not
 *  depend on them, so a detector that was restarted gives the same bits. */
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
  /** Triangles and reflex edges around one node, valid while it stays near `centre`. */
  struct Candidates
  {
    Eigen::Vector3d centre = Eigen::Vector3d::Zero();
    double radius = -1.0;  ///< everything within this of the centre is listed [m]
    double clear = 0.0;    ///< nothing is within this of the centre [m]
    std::vector<int> triangles;
    std::vector<int> reflex_edges;
  };

  void refresh(Candidates& candidates, const Eigen::Vector3d& point, double radius);
  void detectNode(const Query& query, std::size_t index, double reach, std::vector<Feature>& features);
  bool faceFeature(const Eigen::Vector3d& point, int triangle, double limit, double reach, Feature& feature,
                   double& distance, bool& outside) const;
  void detectEdge(const Query& query, std::size_t index, std::vector<Feature>& features);
  bool crossing(const Eigen::Vector3d& a, const Eigen::Vector3d& b, int wall_edge, double limit, Feature& feature,
                double& distance) const;
  bool vertexIsMinimum(int vertex, const Eigen::Vector3d& offset) const;
  void appendDistinct(std::vector<Feature>& features, std::size_t first, const Feature& feature) const;
  void freeDistances(const Query& query, ContactSet& set) const;

  Wall wall_;
  Bvh bvh_;
  WallLaw law_;
  std::uint64_t vessel_version_;
  std::vector<Candidates> candidates_;
  std::vector<int> edge_pool_;
  std::vector<char> edge_marked_;
};

}  // namespace endovascular_sim::contact
