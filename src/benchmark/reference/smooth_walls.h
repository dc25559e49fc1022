#pragma once

#include <cstdint>

#include "contact/contract/contact_set.h"

namespace endovascular_sim::benchmark
{

/** Wall in closed form with contact at the nodes, for references without facets. Its sizes refer to the axis of the
 * wire: the radius of the wire counts as part of the wall. */
class SmoothWall : public contact::ContactSource
{
public:
  void detect(const contact::Query& query, contact::ContactSet& set) override;
  void freeDistances(const contact::Query& query, double wanted, contact::ContactSet& set) override;

protected:
  /** Sets normal, gap and closest point of a face of the wall.
   *  @param axis position of a node [m]
   *  @param face number of the face, from 0
   *  @return false without such a face */
  virtual bool measure(const Eigen::Vector3d& axis, int face, contact::Feature& feature) const = 0;
};

/** Channel between the planes y = 0 and y = height [m]. */
class FlatChannel : public SmoothWall
{
public:
  explicit FlatChannel(double height) : height_(height) {}

protected:
  bool measure(const Eigen::Vector3d& axis, int face, contact::Feature& feature) const override;

private:
  double height_;
};

/** Solid cylinder along z, with the wire outside. */
class Peg : public SmoothWall
{
public:
  /** @param centre any point of the axis of the peg [m]
   *  @param radius radius of the peg [m] */
  Peg(const Eigen::Vector3d& centre, double radius, double friction)
    : centre_(centre), radius_(radius), friction_(friction)
  {
  }

protected:
  bool measure(const Eigen::Vector3d& axis, int face, contact::Feature& feature) const override;

private:
  Eigen::Vector3d centre_;
  double radius_;
  double friction_;
};

/** Straight tube about the x axis, with the wire inside. */
class Trough : public SmoothWall
{
public:
  /** @param clearance largest distance between the axes of wire and tube [m] */
  Trough(double clearance, double friction) : clearance_(clearance), friction_(friction) {}

protected:
  bool measure(const Eigen::Vector3d& axis, int face, contact::Feature& feature) const override;

private:
  double clearance_;
  double friction_;
};

/** Tube: straight along x, an arc towards y, and a straight continuation. */
class BentTube : public SmoothWall
{
public:
  /** @param clearance largest distance between the axes of wire and tube [m]
   *  @param straight length along x before the bend, which begins at (straight, 0, 0) [m]
   *  @param radius radius of the bend, infinite for a straight tube [m]
   *  @param angle angle of the bend, at most π [rad] */
  BentTube(double clearance, double straight, double radius, double angle, double friction = 0.0)
    : clearance_(clearance), straight_(straight), radius_(radius), angle_(angle), friction_(friction)
  {
  }

protected:
  bool measure(const Eigen::Vector3d& axis, int face, contact::Feature& feature) const override;

private:
  Eigen::Vector3d closestPointOnAxis(const Eigen::Vector3d& point) const;

  double clearance_;
  double straight_;
  double radius_;
  double angle_;
  double friction_;
};

}  // namespace endovascular_sim::benchmark
