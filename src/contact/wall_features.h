#pragma once

#include <cstddef>
#include <vector>

#include <Eigen/Core>

#include "contact/broad_phase/wire_lists.h"
#include "contact/contract/contact_set.h"
#include "contact/wall_model.h"

namespace endovascular_sim::contact
{

/** Contact features of one shape of wall: the narrow phase of the detector for a whole wire. */
class WallFeatures
{
public:
  virtual ~WallFeatures() = default;

  /** Appends the features of all nodes and then those between them, without the wall's law.
   *  @param lists up to date for the query */
  virtual void find(const WallModel& model, const WireLists& lists, const Query& query,
                    std::vector<Feature>& features) = 0;

  /** Lower bound of the distance from a point to the listed triangles that may be a contact within the cutoff; larger
   *  than it or infinite without one [m]. */
  virtual double distanceToListed(const WallModel& model, const NeighbourList& list, const Eigen::Vector3d& point,
                                  double cutoff) const = 0;
};

/** Appends a feature unless one of the node's features has the same normal; of two equal ones the closer remains.
 *  @param first index of the node's first feature */
void appendDistinct(std::vector<Feature>& features, std::size_t first, const Feature& feature);

}  // namespace endovascular_sim::contact
