#pragma once

#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "results/wall_force_map.h"

namespace endovascular_sim::results
{

/** Value of `wall_forces` in report.json and result.json (docs/SIMULATE.md), SI units.
 *  @param triangles number of triangles with contact */
nlohmann::ordered_json toJson(const WallForceSummary& summary, std::size_t triangles);

/** Row of wall_forces.csv. */
struct WallForceRow
{
  WallForce force;
  Eigen::Vector3d centre = Eigen::Vector3d::Zero();  ///< centre of the triangle [m]
  std::string region;                                ///< name of the branch
};

/** Text of wall_forces.csv: a header and one row per triangle with contact, sorted by index, SI units. */
std::string wallForcesCsv(std::vector<WallForceRow> rows);

/** Text of vessel_points.csv, the background of the plots: every n-th vertex of the wall, at most @p limit vertices. */
std::string vesselPointsCsv(const std::vector<Eigen::Vector3d>& vertices, std::size_t limit = 5000);

}  // namespace endovascular_sim::results
