#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

#include <Eigen/Core>

#include "contact/broad_phase/wire_lists.h"
#include "contact/contract/contact_set.h"
#include "contact/wall/wall.h"
#include "contact/wall/wall_law.h"
#include "contact/wall_features.h"
#include "contact/wall_model.h"

namespace endovascular_sim::contact
{

/** Contact detection between a wire and a vessel's wall: exact local minima of the distance between the wire's axis and
 *  the wall (docs/CONTACT.md).
 *
 *  Node contacts are the closest points on the triangles around a node that are local minima, one per normal. Edge
 *  contacts are the reflex edges and vertices of the mesh that an edge of the wire crosses. Broad phase: a neighbour
 *  list per node (WireLists). Narrow phase: exact tests of the listed features (WallFeatures). Results do not depend on
 * earlier queries: a new detector gives the same bits. */
class Detector : public ContactSource
{
public:
  /** @param model may be shared with any number of detectors
   *  @param vessel_version reported in every set */
  Detector(std::shared_ptr<const WallModel> model, WallLaw law, std::uint64_t vessel_version = 1);

  /** A detector with a wall model of its own. @param mesh watertight and oriented, normals out of the lumen */
  Detector(const geometry::TriangleMesh& mesh, WallLaw law, std::uint64_t vessel_version = 1);

  void detect(const Query& query, ContactSet& set) override;
  void freeDistances(const Query& query, double wanted, ContactSet& set) override;

  /** Moves vertices of the wall. Afterwards all results are, bit for bit, those of a detector of the moved mesh. Other
   *  detectors of a shared model keep their wall: the first movement copies a model that is shared. The cost of every
   *  other movement depends on the number of vertices only.
   *  @param indices distinct vertices of the mesh
   *  @param positions new positions, one per index [m]
   *  @param vessel_version reported in every set from now on */
  void moveVertices(const std::vector<int>& indices, const std::vector<Eigen::Vector3d>& positions,
                    std::uint64_t vessel_version);

  /** Copies a model that is shared, which the first movement does otherwise. */
  void ownModel() { WallModel::writable(model_); }

  /** Signed distance from a point to the wall, see WallModel::signedDistance [m]. */
  double signedDistance(const Eigen::Vector3d& point, int hint = -1, int* nearest = nullptr) const
  {
    return model_->signedDistance(point, hint, nearest);
  }

  const Wall& wall() const { return model_->wall(); }

  /** Version of the vessel that every set reports; each movement of the wall has another one. */
  std::uint64_t vesselVersion() const { return vessel_version_; }

  /** The wall model, for further detectors. */
  const std::shared_ptr<const WallModel>& model() const { return model_; }

private:
  void begin(const Query& query, ContactSet& set);
  void applyLaw(std::vector<Feature>& features) const;
  double wallDistance(const Query& query, std::size_t node, double farthest);

  std::shared_ptr<const WallModel> model_;
  WallLaw law_;
  std::uint64_t vessel_version_;
  std::unique_ptr<WallFeatures> features_;  ///< of the wall's shape
  WireLists lists_;
  std::vector<int> nearest_;  ///< per node of the whole wire: nearest triangle of its last search, or −1
};

}  // namespace endovascular_sim::contact
