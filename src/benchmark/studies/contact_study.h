#pragma once

#include <vector>

#include <Eigen/Core>

#include "benchmark/harness/study.h"
#include "geometry/triangle_mesh.h"

namespace endovascular_sim::benchmark
{

/** Detection: which bounding volume is best, time per step of a wire that slides along a wall, and how it grows with
 * the triangles. Without meshes of ENDOVASCULAR_DATA_DIR it uses a generated channel, and says so. */
std::vector<Section> contactStudy(const StudyOptions& options, const Progress& progress);

/** A curve that lies on a wall all along: every place at the same distance from it.
 *  @param start a point in the lumen [m]
 *  @param direction in which it begins
 *  @param distance to the wall [m]
 *  @param spacing of the places [m] */
std::vector<Eigen::Vector3d> curveAlongWall(const geometry::TriangleMesh& mesh, const Eigen::Vector3d& start,
                                            const Eigen::Vector3d& direction, double distance, double spacing,
                                            int count);

}  // namespace endovascular_sim::benchmark
