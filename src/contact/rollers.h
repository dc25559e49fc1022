#pragma once

#include <cstddef>
#include <utility>
#include <vector>

#include <Eigen/Core>

#include "contact/contract/contact_set.h"

namespace endovascular_sim::contact
{

/** Rigid cylinder of infinite length that stands in the way of a wire, e.g. a support of a bending test. */
struct Roller
{
  Eigen::Vector3d position = Eigen::Vector3d::Zero();  ///< a point of its axis [m]
  Eigen::Vector3d axis = Eigen::Vector3d::UnitZ();     ///< unit vector
  double radius = 0.0;                                 ///< [m]
  double friction = 0.0;                               ///< Coulomb coefficient
};

/** Contact sets of a wire with rollers, by the exact distance between its edges and their axes.
 *
 *  A feature is a local minimum of the distance along the wire, inside an edge or at a node. Without friction a wire
 *  is free along itself. A node that bulges towards a roller has one minimum; where the wire bends around the roller,
 *  both edges of the node have one. */
class Rollers : public ContactSource
{
public:
  explicit Rollers(std::vector<Roller> rollers) : rollers_(std::move(rollers)) {}

  void detect(const Query& query, ContactSet& set) override;
  void freeDistances(const Query& query, double wanted, ContactSet& set) override;

  const std::vector<Roller>& rollers() const { return rollers_; }

  /** Moves a roller; contact sets from now on are those of the new position.
   *  @param position of a point of its axis [m] */
  void moveTo(std::size_t roller, const Eigen::Vector3d& position) { rollers_[roller].position = position; }

private:
  void addFeatures(const Query& query, std::size_t roller, std::vector<Feature>& features) const;

  std::vector<Roller> rollers_;
};

/** Distance of a point from the axis of a roller [m]. */
double distanceFromAxis(const Roller& roller, const Eigen::Vector3d& point);

/** Distance of a point from the surface of a roller, negative inside [m]. */
double distanceFrom(const Roller& roller, const Eigen::Vector3d& point);

}  // namespace endovascular_sim::contact
