#pragma once

#include <vector>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "vessel/anatomy/anatomy.h"

namespace endovascular_sim::vessel
{

/** Implicit function of the vessel at a point. */
struct FieldSample
{
  double distance = 0.0;  ///< approximate signed distance to the wall, negative in the lumen; exact for a cylinder [m]
  Eigen::Vector3d gradient = Eigen::Vector3d::UnitZ();  ///< gradient of the distance, of length about 1
  double edge_length = 0.0;                             ///< target edge length of the mesh near the point [m]
};

/** Implicit surface of the lumen. A branch is the set of points closer to its centreline than the radius at the foot
 *  point, so that cross-sections have exactly the specified diameter. Branches are blended by a smooth minimum (cubic
 *  polynomial by I. Quilez, C²). Its range is a multiple of the smaller branch's radius. */
class ImplicitVessel
{
public:
  ImplicitVessel(const Anatomy& anatomy, std::vector<AnatomyChain> chains);

  FieldSample at(const Eigen::Vector3d& p) const;

  /** Bounding box of the wall. */
  const Eigen::AlignedBox3d& bounds() const { return bounds_; }

private:
  /** Consecutive segments of a chain with a bounding sphere of their axis. */
  struct Cluster
  {
    Eigen::Vector3d centre;
    double reach = 0.0;   ///< radius of the bounding sphere [m]
    double widest = 0.0;  ///< largest radius of the lumen [m]
    std::size_t begin = 0;
    std::size_t end = 0;
  };

  struct Tube
  {
    AnatomyChain chain;
    std::vector<double> radius_slope;
    std::vector<Cluster> clusters;
    Eigen::AlignedBox3d axis_box;
    double widest = 0.0;
    double shortest_edge = 0.0;
    double facet_per_radius = 0.0;  ///< edge length of the mesh, in radii of the lumen
  };

  /** Distance function of one tube at a point. */
  struct TubeSample
  {
    double distance = 1e300;
    Eigen::Vector3d gradient = Eigen::Vector3d::UnitZ();
    double radius = 0.0;
  };

  void addTube(AnatomyChain chain);
  TubeSample sampleTube(const Tube& tube, const Eigen::Vector3d& p) const;
  double edgeLengthFor(const Tube& tube, double radius) const;

  double blend_;
  double facet_per_radius_;
  double longest_facet_;
  std::vector<Tube> tubes_;
  std::vector<Bulge> bulges_;
  Eigen::AlignedBox3d bounds_;
};

}  // namespace endovascular_sim::vessel
