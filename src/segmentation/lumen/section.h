#pragma once

#include <array>
#include <cstddef>
#include <string>
#include <vector>

#include <Eigen/Core>

namespace endovascular_sim::segmentation
{

/** Number of rays of a cross-section. */
constexpr int kRays = 48;

/** Cross-section of the lumen: a star-shaped contour about a point of the centreline. */
struct Section
{
  Eigen::Vector3d centre = Eigen::Vector3d::Zero();    ///< grid frame [m]
  Eigen::Vector3d tangent = Eigen::Vector3d::UnitZ();  ///< unit normal of the section, towards the end of the branch
  Eigen::Vector3d u = Eigen::Vector3d::UnitX();        ///< unit vector of ray 0
  Eigen::Vector3d w = Eigen::Vector3d::UnitY();        ///< tangent × u
  std::array<double, kRays> radii{};                   ///< distance of the edge along the rays, counter-clockwise [m]
  double lumen = 0.0;                                  ///< value of the lumen
  double edges = 0.0;                                  ///< share of the rays that have an edge of their own
  double calcium = 0.0;                                ///< share of the rays that end at calcium

  /** Direction of a ray. */
  Eigen::Vector3d direction(int ray) const;

  /** Radius in a direction of the section's plane, linear between the rays [m].
   *  @param angle from u towards w [rad] */
  double radiusAt(double angle) const;

  /** Area within the contour [m²]. */
  double area() const;

  /** Diameter of the circle of equal area [m]. */
  double diameter() const;

  /** Centre of the area [m]. */
  Eigen::Vector3d centroid() const;
};

/** Lumen of one branch. */
struct LumenBranch
{
  std::string name;
  int parent = -1;              ///< index of the parent branch; −1 at the root
  double largest_radius = 0.0;  ///< length of the rays [m]
  std::vector<Section> sections;

  /** Arc length of the centreline at every section [m]. */
  std::vector<double> arc() const;
};

}  // namespace endovascular_sim::segmentation
