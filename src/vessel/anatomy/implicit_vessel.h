#pragma once

#include <vector>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "vessel/anatomy/anatomy.h"

namespace endovascular_sim::vessel
{

/** Value of the implicit vessel at a point. */
struct FieldSample
{
  double distance = 0.0;  ///< to the wall, negative in the lumen; exact beside a straight even branch [m]
  Eigen::Vector3d gradient = Eigen::Vector3d::UnitZ();  ///< direction of steepest ascent, length about 1
  double facet = 0.0;  ///< edge length that the wall's mesh should have near this point [m]
};

/** The lumen as an implicit surface: every branch is the set of points closer to its centreline than its radius there,
 *  so that a cut across the centreline has exactly the diameter given; branches are joined by a smooth minimum
 *  (I. Quilez's cubic polynomial, C²) whose range is a multiple of the smaller branch's radius. */
class ImplicitVessel
{
public:
  ImplicitVessel(const Anatomy& anatomy, std::vector<AnatomyChain> chains);

  FieldSample at(const Eigen::Vector3d& p) const;

  /** Box round the whole wall. */
  const Eigen::AlignedBox3d& bounds() const { return bounds_; }

private:
  /** Some neighbouring segments of a chain inside a ball, lumen included. */
  struct Cluster
  {
    Eigen::Vector3d centre;
    double reach = 0.0;   ///< of the axis from the centre [m]
    double widest = 0.0;  ///< largest radius [m]
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
    double finest_facet = 0.0;
  };

  /** A branch seen from a point. */
  struct TubeSample
  {
    double distance = 1e300;
    Eigen::Vector3d gradient = Eigen::Vector3d::UnitZ();
    double radius = 0.0;
  };

  void addTube(AnatomyChain chain);
  TubeSample sampleTube(const Tube& tube, const Eigen::Vector3d& p) const;
  double facetFor(double radius) const;

  double blend_;
  double facet_per_radius_;
  double longest_facet_;
  std::vector<Tube> tubes_;
  std::vector<Bulge> bulges_;
  Eigen::AlignedBox3d bounds_;
};

}  // namespace endovascular_sim::vessel
