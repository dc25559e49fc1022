#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include <Eigen/Core>

namespace endovascular_sim::segmentation
{

/** Number of rays of a cross-section. */
constexpr int kRays = 48;

/** Finding at the end of a ray. */
enum class RayEnd : std::uint8_t
{
  kOpen,     ///< no edge up to the reach of the section
  kDropped,  ///< an edge that does not fit those of the neighbours, e.g. in a side branch
  kWall,     ///< edge of the lumen
  kCalcium,  ///< plaque that borders on the lumen
  kBone,     ///< edge of the lumen before bone, with a soft gap between the two
};

/** Cross-section of the lumen: a star-shaped contour about a point of the centreline. */
struct Section
{
  Eigen::Vector3d centre = Eigen::Vector3d::Zero();    ///< grid frame [m]
  Eigen::Vector3d tangent = Eigen::Vector3d::UnitZ();  ///< unit normal of the section, towards the end of the branch
  Eigen::Vector3d u = Eigen::Vector3d::UnitX();        ///< unit vector of ray 0
  Eigen::Vector3d w = Eigen::Vector3d::UnitY();        ///< tangent × u
  std::array<double, kRays> radii{};                   ///< distance of the edge along the rays, counter-clockwise [m]
  std::array<RayEnd, kRays> ends{};                    ///< what the rays have found
  double reach = 0.0;                                  ///< length of the rays [m]
  double lumen = 0.0;                                  ///< value of the lumen
  double middle = 1.0;                                 ///< contrast in the middle, as a share of that of the lumen
  double blur = 0.0;                                   ///< standard deviation of the blur across the section [m]

  /** Share of the rays that have an edge of their own. */
  double edges() const;

  /** Share of the rays with a finding. */
  double share(RayEnd end) const;

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
