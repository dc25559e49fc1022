#pragma once

#include <Eigen/Core>
#include <limits>
#include <optional>
#include <string>
#include <vector>

namespace endovascular_sim::vessel
{

/** A stenosis of one branch, as a scene asks for it. */
struct Lesion
{
  std::string branch;  ///< name of a branch of the centreline
  /** Instead of a branch and a place along it: a point near the centreline in its middle, patient frame [m]. */
  std::optional<Eigen::Vector3d> at;
  /** Of its middle along the branch's centreline [m]; NaN: `fraction` of the branch's length instead. */
  double from_start = std::numeric_limits<double>::quiet_NaN();
  double fraction = 0.5;
  double length = 0.0;  ///< of the whole narrowing along the centreline [m]
  double grade = 0.0;   ///< share of the diameter that is lost in its middle, 0 to 0.99
  /** 0: the lumen stays in the middle; 1: all plaque is on one side, and the wall opposite stays as it was. */
  double eccentricity = 0.0;
  /** Of the plaque's side about the branch's direction [rad]; 0 is the patient's left (x), or posterior (y) where the
   *  branch runs along x. */
  double angle = 0.0;
};

/** A lesion that a vessel has. */
struct PlacedLesion
{
  Lesion lesion;
  int branch = -1;                 ///< index into the vessel's centreline
  double begin = 0.0;              ///< along that branch's centreline [m]
  double middle = 0.0;             ///< [m]
  double end = 0.0;                ///< [m]
  double healthy_diameter = 0.0;   ///< of the lumen in the lesion's middle before it was made (equal area) [m]
  double narrowed_diameter = 0.0;  ///< and after [m]
};

}  // namespace endovascular_sim::vessel
