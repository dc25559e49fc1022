#pragma once

#include <Eigen/Core>
#include <limits>
#include <optional>
#include <string>
#include <vector>

namespace endovascular_sim::vessel
{

/** Stenosis of one branch, as specified in a scene. */
struct Lesion
{
  std::string branch;  ///< name of a branch of the centreline
  /** Centre of the lesion as a point in the patient frame [m]; replaces branch and arc length. */
  std::optional<Eigen::Vector3d> at;
  /** Arc length of the centre from the start of the branch [m]; NaN selects `fraction`. */
  double from_start = std::numeric_limits<double>::quiet_NaN();
  double fraction = 0.5;  ///< position of the centre as a fraction of the branch's length
  double length = 0.0;    ///< length of the stenosis along the centreline [m]
  double grade = 0.0;     ///< diameter stenosis at the throat, 0 to 0.99
  /** 0: concentric; 1: plaque on one side only, so that the opposite wall is unchanged. */
  double eccentricity = 0.0;
  /** Direction of the plaque about the branch's tangent [rad]. 0 is the patient's left (x), or posterior (y) for a
   *  branch along x. */
  double angle = 0.0;
};

/** Lesion in the wall of a vessel. */
struct PlacedLesion
{
  Lesion lesion;                   ///< specification
  int branch = -1;                 ///< index into the vessel's centreline
  double begin = 0.0;              ///< arc length of the proximal end on the branch [m]
  double middle = 0.0;             ///< arc length of the throat [m]
  double end = 0.0;                ///< arc length of the distal end [m]
  double healthy_diameter = 0.0;   ///< equal-area diameter at the throat without the lesion [m]
  double narrowed_diameter = 0.0;  ///< equal-area diameter at the throat with the lesion [m]
};

}  // namespace endovascular_sim::vessel
