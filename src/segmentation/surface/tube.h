#pragma once

#include <vector>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "segmentation/lumen/section.h"

namespace endovascular_sim::segmentation
{

/** Implicit tube through the contours of a branch, with flat ends. */
class Tube
{
public:
  /** Value of the tube at a point. */
  struct Sample
  {
    double distance = 1e30;  ///< distance from the wall within the plane of the section, negative inside [m]
    Eigen::Vector3d outward = Eigen::Vector3d::Zero();  ///< unit vector from the centreline
    double radius = 0.0;                                ///< of the contour in this direction [m]
  };

  /** Piece between two sections. Its points lie before the plane of the second one, and not before that of the first.
   */
  struct Piece
  {
    std::size_t first = 0;
    Eigen::Vector3d centre = Eigen::Vector3d::Zero();
    double reach = 0.0;  ///< radius of a ball around the piece [m]
  };

  /** @param margin distance outside of the wall up to which samples are wanted [m] */
  Tube(const std::vector<Section>& sections, double margin);

  const std::vector<Piece>& pieces() const { return pieces_; }

  /** False if no point of a ball belongs to a piece. */
  bool isNear(const Piece& piece, const Eigen::Vector3d& centre, double radius) const;

  /** Value of one piece at a point; no change where the point does not belong to it. */
  void sample(const Piece& piece, const Eigen::Vector3d& p, Sample& result) const;

  /** Value of the whole tube at a point. */
  Sample at(const Eigen::Vector3d& p) const;

private:
  std::vector<Section> sections_;
  std::vector<Piece> pieces_;
};

}  // namespace endovascular_sim::segmentation
