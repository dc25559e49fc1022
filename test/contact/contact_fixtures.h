#pragma once

#include <cstdlib>
#include <cstring>
#include <random>
#include <string>

#include <gtest/gtest.h>

#include "contact/detector.h"
#include "geometry/closest_point_on_triangle.h"
#include "geometry/loop_subdivision.h"
#include "vessel/anatomy/tube.h"
#include "vessel/io/mesh_reader.h"
#include "vessel/repair/mesh_repair.h"

namespace endovascular_sim::contact
{

/** A bent channel of 4 mm radius with coarse facets. */
inline geometry::TriangleMesh bentTube()
{
  vessel::TubeShape shape;
  shape.radius = 4e-3;
  shape.facet_length = 5e-3;
  shape.facets_around = 12;
  shape.pieces = {{0.03, 0.0, 0.0}, {0.04, 50.0, 0.3}, {0.02, 0.0, 0.0}};
  return vessel::tubeMesh(shape);
}

/** A mesh with random displacements of its vertices along their normals.
 *  @param bump largest displacement as a share of an edge's length */
inline geometry::TriangleMesh bumpy(geometry::TriangleMesh mesh, double bump)
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

inline geometry::TriangleMesh bumpyTube(double bump)
{
  return bumpy(geometry::midpointSubdivision(bentTube(), 2), bump);
}

/** Path of a mesh in ENDOVASCULAR_DATA_DIR; empty if the variable is not set. */
inline std::string dataFile(const std::string& name)
{
  const char* folder = std::getenv("ENDOVASCULAR_DATA_DIR");
  return folder == nullptr ? "" : std::string(folder) + "/" + name;
}

inline geometry::TriangleMesh realMesh(const std::string& file)
{
  return vessel::repairMesh(vessel::readMesh(file, 1e-3), file).mesh;
}

/** Distance to the wall by brute force over all triangles. */
inline double bruteDistance(const Wall& wall, const Eigen::Vector3d& p, int& triangle)
{
  double best = 1e9;
  for (std::size_t t = 0; t < wall.triangles.size(); ++t)
  {
    const Eigen::Vector3i& c = wall.triangles[t];
    const double distance =
        (geometry::closestPointOnTriangle(p, wall.vertices[c[0]], wall.vertices[c[1]], wall.vertices[c[2]]).point - p)
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
  query.margin.assign(static_cast<std::size_t>(nodes), 0.5e-3);
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

template <typename Number>
bool sameBits(const Number& a, const Number& b)
{
  return std::memcmp(&a, &b, sizeof a) == 0;
}

inline void expectSameSets(const ContactSet& a, const ContactSet& b)
{
  EXPECT_EQ(a.vessel_version, b.vessel_version);
  EXPECT_EQ(a.free_distance, b.free_distance);
  ASSERT_EQ(a.features.size(), b.features.size());
  for (std::size_t k = 0; k < a.features.size(); ++k)
  {
    const Feature& x = a.features[k];
    const Feature& y = b.features[k];
    EXPECT_EQ(x.id, y.id);
    EXPECT_EQ(x.edge, y.edge);
    EXPECT_EQ(x.triangle, y.triangle);
    EXPECT_TRUE(sameBits(x.parameter, y.parameter));
    EXPECT_TRUE(sameBits(x.point, y.point));
    EXPECT_TRUE(sameBits(x.normal, y.normal));
    EXPECT_TRUE(sameBits(x.gap, y.gap));
    EXPECT_TRUE(sameBits(x.friction, y.friction));
    EXPECT_TRUE(sameBits(x.clearance_radius, y.clearance_radius));
  }
}

/** New positions of some vertices. */
struct Movement
{
  std::vector<int> indices;
  std::vector<Eigen::Vector3d> positions;
};

/** Radial expansion of a ball. @param share displacement near the centre as a share of the distance from it */
inline Movement pushOut(const geometry::TriangleMesh& mesh, const Eigen::Vector3d& centre, double radius, double share)
{
  Movement movement;
  for (std::size_t v = 0; v < mesh.vertices.size(); ++v)
  {
    const Eigen::Vector3d out = mesh.vertices[v] - centre;
    const double t = out.norm() / radius;
    if (t >= 1.0)
      continue;
    movement.indices.push_back(static_cast<int>(v));
    movement.positions.emplace_back(mesh.vertices[v] + share * (1.0 - t) * out);
  }
  return movement;
}

inline void apply(const Movement& movement, geometry::TriangleMesh& mesh)
{
  for (std::size_t k = 0; k < movement.indices.size(); ++k)
    mesh.vertices[static_cast<std::size_t>(movement.indices[k])] = movement.positions[k];
}

inline void expectSameWalls(const Wall& a, const Wall& b)
{
  EXPECT_EQ(a.normals, b.normals);
  EXPECT_EQ(a.plane_offsets, b.plane_offsets);
  EXPECT_EQ(a.vertex_normals, b.vertex_normals);
  EXPECT_EQ(a.vertex_reflex, b.vertex_reflex);
  EXPECT_EQ(a.vertex_cone, b.vertex_cone);
  EXPECT_EQ(a.curvature, b.curvature);
  for (std::size_t e = 0; e < a.edges.size(); ++e)
  {
    EXPECT_EQ(a.edges[e].reflex_angle, b.edges[e].reflex_angle);
    EXPECT_EQ(a.edges[e].normal, b.edges[e].normal);
    EXPECT_EQ(a.edges[e].into_triangle, b.edges[e].into_triangle);
  }
}

}  // namespace endovascular_sim::contact
