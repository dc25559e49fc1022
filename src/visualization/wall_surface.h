#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "geometry/triangle_mesh.h"
#include "visualization/tube_surface.h"

namespace endovascular_sim::visualization
{

/** Reason why a mesh cannot be drawn; null for a valid one. */
const char* problemOfMesh(const geometry::TriangleMesh& mesh);

/** Smooth surface of the wall: one vertex per vertex of the mesh, with angle-weighted normals out of the lumen.
 *  @param mesh valid (problemOfMesh()) */
Surface wallSurface(const geometry::TriangleMesh& mesh, const TranslucentColour& colour);

/** Cutaway of the near wall around a point: opacity 0 within half the radius, rising smoothly to @p opacity at the
 * radius.
 *  @param surface its vertices receive the opacity
 *  @param radius [m]; not positive: no cutaway */
void cutAway(const Eigen::Vector3d& point, double radius, float opacity, Surface& surface);

/** Colour and opacity of a value in the heat map: transparent at 0, yellow at one third, orange at two thirds, red. */
TranslucentColour heatColour(double value, double full_scale);

/** Readable form of a branch's name: spaces in place of underscores. */
std::string branchLabel(const std::string& name);

}  // namespace endovascular_sim::visualization
