#pragma once

#include <cstdint>

#include "contact/contract/contact_set.h"

namespace endovascular_sim::benchmark
{

/** Walls in closed form that nodes meet, one feature each: references without facets. The wire's radius counts as part
 *  of the wall: sizes are those that its axis sees. */
class SmoothWall : public contact::ContactSource
{
public:
  void detect(const contact::Query& query, contact::ContactSet& set) override;
  void freeDistances(const contact::Query& query, double wanted, contact::ContactSet& set) override;

protected:
  /** Normal, gap and closest point for a node's axis.
   *  @param face 0, 1, … while it returns true
   *  @return false when there is no such face */
  virtual bool meet(const Eigen::Vector3d& axis, int face, contact::Feature& feature) const = 0;
};

/** Between the planes y = 0 and y = height [m]. */
class FlatChannel : public SmoothWall
{
public:
  explicit FlatChannel(double height) : height_(height) {}

protected:
  bool meet(const Eigen::Vector3d& axis, int face, contact::Feature& feature) const override;

private:
  double height_;
};

/** Outside a cylinder about an axis along z. */
class Peg : public SmoothWall
{
public:
  /** @param centre any point of the peg's axis [m]
   *  @param radius [m] */
  Peg(const Eigen::Vector3d& centre, double radius, double friction)
    : centre_(centre), radius_(radius), friction_(friction)
  {
  }

protected:
  bool meet(const Eigen::Vector3d& axis, int face, contact::Feature& feature) const override;

private:
  Eigen::Vector3d centre_;
  double radius_;
  double friction_;
};

/** Inside a tube along x, then an arc that turns towards y, then straight on; frictionless. */
class BentTube : public SmoothWall
{
public:
  /** @param clearance of the wire's axis from the tube's [m]
   *  @param straight length along x before the bend, which begins at (straight, 0, 0) [m]
   *  @param radius of the bend, infinite for a straight tube [m]
   *  @param angle of the bend, less than π [rad] */
  BentTube(double clearance, double straight, double radius, double angle)
    : clearance_(clearance), straight_(straight), radius_(radius), angle_(angle)
  {
  }

protected:
  bool meet(const Eigen::Vector3d& axis, int face, contact::Feature& feature) const override;

private:
  Eigen::Vector3d nearestOfTheAxis(const Eigen::Vector3d& point) const;

  double clearance_;
  double straight_;
  double radius_;
  double angle_;
};

}  // namespace endovascular_sim::benchmark
