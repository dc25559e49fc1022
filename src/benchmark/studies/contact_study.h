#pragma once

#include <vector>

#include <Eigen/Core>

#include "benchmark/harness/study.h"
#include "geometry/triangle_mesh.h"

namespace endovascular_sim::benchmark
{

/** Tables of contactStudy(). */
std::vector<TableSpec> contactTables();

/** Contact detection: comparison of bounding volumes, time per step of a sliding wire over the number of triangles, and
 *  detection within a simulation. Without meshes of ENDOVASCULAR_DATA_DIR a generated channel replaces them. */
std::vector<Section> contactStudy(const StudyOptions& options, const Progress& progress);

/** Curve at a constant distance from a wall.
 *  @param start point in the lumen [m]
 *  @param direction initial direction
 *  @param distance distance to the wall [m]
 *  @param spacing distance between points [m]
 *  @param count number of points */
std::vector<Eigen::Vector3d> curveAlongWall(const geometry::TriangleMesh& mesh, const Eigen::Vector3d& start,
                                            const Eigen::Vector3d& direction, double distance, double spacing,
                                            int count);

}  // namespace endovascular_sim::benchmark
