#pragma once

#include <cstdlib>
#include <random>
#include <string>

#include "contact/detector.h"
#include "vessel/mesh_reader.h"
#include "vessel/mesh_repair.h"
#include "vessel/subdivision.h"
#include "vessel/triangle_point.h"
#include "vessel/tube.h"

namespace endovascular_sim::contact
{

/** A bent channel of 4 mm radius, coarsely facetted so that its facets matter. */
inline vessel::TriangleMesh bentTube()
{
  vessel::TubeShape shape;
  shape.radius = 4e-3;
  shape.facet_length = 5e-3;
  shape.facets_around = 12;
  shape.pieces = {{0.03, 0.0, 0.0}, {0.04, 50.0, 0.3}, {0.02, 0.0, 0.0}};
  return vessel::tubeMesh(shape);
}

/** A wall whose facets' corners are moved in and out by a share of their size. */
inline vessel::TriangleMesh bumpy(vessel::TriangleMesh mesh, double bump)
{
  const Wall smooth(mesh);
  std::mt19937 random(3);
  std::uniform_real_distribution<double> height(-1.0, 1.0);
  for (std::size_t v = 0; v < mesh.vertices.size(); ++v)
  {
    const WallEdge& edge = smooth.edges[static_cast<std::size_t>(smooth.vertex_edges[v].front())];
    const double length = (mesh.vertices[edge.vertices[1]] - mesh.vertices[edge.vertices[0]]).norm();
    mesh.vertices[v] += bump * height(random) * length * smooth.vertex_normals[v];
  }
  return mesh;
}

inline vessel::TriangleMesh bumpyTube(double bump)
{
  return bumpy(vessel::flatSubdivision(bentTube(), 2), bump);
}

/** Path of a mesh of ENDOVASCULAR_DATA_DIR, empty when it is not there. */
inline std::string dataFile(const std::string& name)
{
  const char* folder = std::getenv("ENDOVASCULAR_DATA_DIR");
  return folder == nullptr ? "" : std::string(folder) + "/" + name;
}

inline vessel::TriangleMesh realMesh(const std::string& file)
{
  return vessel::repairMesh(vessel::readMesh(file, 1e-3), file).mesh;
}

/** Distance to the wall by looking at every triangle. */
inline double bruteDistance(const Wall& wall, const Eigen::Vector3d& p, int& triangle)
{
  double best = 1e9;
  for (std::size_t t = 0; t < wall.triangles.size(); ++t)
  {
    const Eigen::Vector3i& c = wall.triangles[t];
    const double distance =
        (vessel::closestPointOnTriangle(p, wall.vertices[c[0]], wall.vertices[c[1]], wall.vertices[c[2]]).point - p)
            .norm();
    if (distance < best)
    {
      best = distance;
      triangle = static_cast<int>(t);
    }
  }
  return best;
}

/** A random wavy wire of some nodes that starts at a point, mostly inside the vessel's bounding box. */
inline Query randomWire(const Eigen::Vector3d& start, std::mt19937& random, int nodes)
{
  std::normal_distribution<double> normal(0.0, 1.0);
  Query query;
  query.margin = 0.5e-3;
  query.first_node = 3;
  Eigen::Vector3d direction(normal(random), normal(random), normal(random));
  direction.normalize();
  Eigen::Vector3d x = start;
  for (int i = 0; i < nodes; ++i)
  {
    query.nodes.push_back(x);
    query.radius.push_back(0.4e-3);
    direction += 0.25 * Eigen::Vector3d(normal(random), normal(random), normal(random));
    direction.normalize();
    x += 1.8e-3 * direction;
  }
  return query;
}

}  // namespace endovascular_sim::contact
