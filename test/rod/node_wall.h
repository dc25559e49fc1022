#pragma once

#include <algorithm>
#include <limits>
#include <vector>

#include <Eigen/Core>

#include "contact/contract/contact_set.h"

namespace endovascular_sim::rod
{

/** Wall in closed form that touches a wire at its nodes. */
class NodeWall : public contact::ContactSource
{
public:
  void detect(const contact::Query& query, contact::ContactSet& set) override
  {
    margins = query.margin;
    freeDistances(query, 0.0, set);
  }

  void freeDistances(const contact::Query& query, double, contact::ContactSet& set) override
  {
    set.features.clear();
    set.first_edge = query.first_node;
    set.free_distance.clear();
    set.stale = stale;
    const int n = static_cast<int>(query.nodes.size());
    double before = 0.0;
    for (int i = 0; i < n; ++i)
    {
      contact::Feature feature;
      feature.gap = measure(query.nodes[i], query.radius[i], feature);
      if (i > 0)
        set.free_distance.push_back(std::max(0.0, freeBetween(before, feature.gap)));
      before = feature.gap;
      if (feature.gap > query.margin[i])
        continue;
      feature.edge = query.first_node + std::min(i, n - 2);
      feature.parameter = i == n - 1 ? 1.0 : 0.0;
      feature.point = query.nodes[i] - (feature.gap + query.radius[i]) * feature.normal;
      feature.friction = friction;
      feature.stiffness = stiffness;
      feature.id = 3 * i;
      set.features.push_back(feature);
    }
  }

  double friction;
  double stiffness = std::numeric_limits<double>::infinity();  ///< [N/m²]
  std::vector<double> margins;                                 ///< margins of the last query for features [m]
  bool stale = false;                                          ///< mark of every answer

protected:
  explicit NodeWall(double friction) : friction(friction) {}

  /** Sets the normal of the wall at a node. @return gap [m] */
  virtual double measure(const Eigen::Vector3d& node, double radius, contact::Feature& feature) const = 0;

  /** Free distance of an edge between nodes with these gaps [m]. */
  virtual double freeBetween(double before, double after) const { return std::min(before, after); }
};

/** Plane through the origin. */
class PlaneWall : public NodeWall
{
public:
  explicit PlaneWall(double friction, const Eigen::Vector3d& normal = Eigen::Vector3d::UnitZ())
    : NodeWall(friction), normal_(normal)
  {
  }

protected:
  double measure(const Eigen::Vector3d& node, double radius, contact::Feature& feature) const override
  {
    feature.normal = normal_;
    return normal_.dot(node) - radius;
  }

private:
  Eigen::Vector3d normal_;
};

/** Cylinder about the z axis with the wire outside. */
class CylinderWall : public NodeWall
{
public:
  CylinderWall(double radius, double friction) : NodeWall(friction), radius_(radius) {}

protected:
  double measure(const Eigen::Vector3d& node, double radius, contact::Feature& feature) const override
  {
    const Eigen::Vector3d across(node.x(), node.y(), 0.0);
    feature.normal = across.normalized();
    return across.norm() - radius_ - radius;
  }

  double freeBetween(double before, double /*after*/) const override { return 0.5 * before; }

private:
  double radius_;
};

/** Tube about the x axis with the wire inside. */
class TroughWall : public NodeWall
{
public:
  TroughWall(double radius, double friction) : NodeWall(friction), radius_(radius) {}

protected:
  double measure(const Eigen::Vector3d& node, double radius, contact::Feature& feature) const override
  {
    const Eigen::Vector3d across(0.0, node.y(), node.z());
    feature.normal = -across.normalized();
    feature.clearance_radius = radius_ - radius;
    return across.isZero(0.0) ? std::numeric_limits<double>::infinity() : radius_ - across.norm() - radius;
  }

  double freeBetween(double /*before*/, double /*after*/) const override { return 0.0; }

private:
  double radius_;
};

}  // namespace endovascular_sim::rod
