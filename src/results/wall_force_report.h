#pragma once

#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "results/wall_force_map.h"

namespace endovascular_sim::results
{

/** `wall_forces` of report.json and result.json (docs/SIMULATE.md), SI units.
 *  @param triangles how many were touched */
nlohmann::ordered_json toJson(const WallForceSummary& summary, std::size_t triangles);

/** A row of wall_forces.csv. */
struct WallForceRow
{
  WallForce force;
  Eigen::Vector3d centre = Eigen::Vector3d::Zero();  ///< of the triangle [m]
  std::string region;                                ///< name of the branch
};

/** wall_forces.csv: a row per touched triangle, by number, with a head line, SI units. */
std::string wallForcesCsv(std::vector<WallForceRow> rows);

/** vessel_points.csv, the background of the plots: vertices of the wall, evenly thinned out to at most @p most. */
std::string vesselPointsCsv(const std::vector<Eigen::Vector3d>& vertices, std::size_t most = 5000);

}  // namespace endovascular_sim::results
