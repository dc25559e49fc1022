#pragma once

#include <string>
#include <vector>

#include <Eigen/Core>

#include "image/volume_grid.h"

namespace endovascular_sim::image
{

/** Geometry of one slice of a series, from its file. */
struct Slice
{
  std::string file;
  Eigen::Vector2i size = Eigen::Vector2i::Zero();           ///< columns and rows
  Eigen::Vector2d spacing = Eigen::Vector2d::Zero();        ///< of the columns and of the rows [m]
  Eigen::Vector3d origin = Eigen::Vector3d::Zero();         ///< centre of the first pixel [m]
  Eigen::Vector3d along_row = Eigen::Vector3d::UnitX();     ///< direction from column to column
  Eigen::Vector3d along_column = Eigen::Vector3d::UnitY();  ///< direction from row to row
};

/** Slices in the order of a volume. */
struct SliceStack
{
  VolumeGrid grid;
  std::vector<std::string> files;  ///< of the slices, k ascending
};

/** Orders the slices of a series along their normal, and checks that they form a regular grid.
 *  @param source name of the series in errors
 *  @throws InputError for fewer than two slices, sizes, spacings or orientations that differ, two slices at one place,
 *          missing slices, and a gantry tilt; each with the file or the place and a remedy */
SliceStack stackSlices(std::vector<Slice> slices, const std::string& source);

}  // namespace endovascular_sim::image
