#include "vessel/prepare/level_set.h"

#include <openvdb/openvdb.h>
#include <openvdb/tools/MeshToVolume.h>
#include <openvdb/tools/VolumeToMesh.h>

#include <cmath>

#include "common/error.h"
#include "geometry/mesh_topology.h"

namespace endovascular_sim::vessel
{
namespace
{

/** Half-width of the narrow band, in voxels. */
constexpr float kBand = 2.0F;
constexpr int kMaxSeparationRounds = 20;
/** Signed distance assigned to grid points between touching sheets, in voxels. */
constexpr float kOutside = 0.25F;

/** Signed distance grid in voxels, negative inside. */
openvdb::FloatGrid::Ptr signedDistance(const geometry::TriangleMesh& mesh, double voxel)
{
  std::vector<openvdb::Vec3s> points;
  points.reserve(mesh.vertices.size());
  for (const Eigen::Vector3d& v : mesh.vertices)
    points.emplace_back(openvdb::Vec3d(v.x() / voxel, v.y() / voxel, v.z() / voxel));
  std::vector<openvdb::Vec3I> triangles;
  triangles.reserve(mesh.triangles.size());
  for (const Eigen::Vector3i& t : mesh.triangles)
    triangles.emplace_back(static_cast<openvdb::Index32>(t[0]), static_cast<openvdb::Index32>(t[1]),
                           static_cast<openvdb::Index32>(t[2]));
  const openvdb::tools::QuadAndTriangleDataAdapter<openvdb::Vec3s, openvdb::Vec3I> adapter(points, triangles);
  const openvdb::math::Transform identity;
  return openvdb::tools::meshToVolume<openvdb::FloatGrid>(adapter, identity, kBand, kBand);
}

/** Triangulated zero level of the grid; quads are split along their shorter diagonal. */
geometry::TriangleMesh zeroLevel(const openvdb::FloatGrid& grid, double voxel)
{
  std::vector<openvdb::Vec3s> points;
  std::vector<openvdb::Vec3I> triangles;
  std::vector<openvdb::Vec4I> quads;
  openvdb::tools::volumeToMesh(grid, points, triangles, quads, 0.0, 0.0);
  geometry::TriangleMesh mesh;
  mesh.vertices.reserve(points.size());
  for (const openvdb::Vec3s& p : points)
    mesh.vertices.emplace_back(voxel * Eigen::Vector3d(p.x(), p.y(), p.z()));
  const auto add = [&mesh](openvdb::Index32 a, openvdb::Index32 b, openvdb::Index32 c)
  { mesh.triangles.emplace_back(static_cast<int>(a), static_cast<int>(b), static_cast<int>(c)); };
  // OpenVDB orients faces clockwise seen from outside.
  for (const openvdb::Vec3I& t : triangles)
    add(t[0], t[2], t[1]);
  for (const openvdb::Vec4I& q : quads)
  {
    const bool first = (points[q[0]] - points[q[2]]).lengthSqr() <= (points[q[1]] - points[q[3]]).lengthSqr();
    add(q[0], q[2], q[1]);
    if (first)
      add(q[0], q[3], q[2]);
    else
    {
      mesh.triangles.back() = {static_cast<int>(q[0]), static_cast<int>(q[3]), static_cast<int>(q[1])};
      add(q[1], q[3], q[2]);
    }
  }
  return mesh;
}

/** Midpoints of edges with more than two faces, and vertices shared by separate sheets. */
std::vector<Eigen::Vector3d> nonManifoldLocations(const geometry::TriangleMesh& mesh)
{
  std::vector<Eigen::Vector3d> locations;
  const std::vector<geometry::HalfEdge> half_edges = geometry::sortedHalfEdges(mesh);
  for (std::size_t begin = 0; begin < half_edges.size(); begin = geometry::endOfEdge(half_edges, begin))
    if (geometry::endOfEdge(half_edges, begin) - begin != 2)
      locations.emplace_back(0.5 * (mesh.vertices[static_cast<std::size_t>(half_edges[begin].low)] +
                                    mesh.vertices[static_cast<std::size_t>(half_edges[begin].high)]));
  for (const int v : geometry::nonManifoldVertices(mesh, half_edges))
    locations.push_back(mesh.vertices[static_cast<std::size_t>(v)]);
  return locations;
}

/** Separates touching sheets: the corners of the cells at these locations are set to outside. */
void separateSheets(openvdb::FloatGrid& grid, const std::vector<Eigen::Vector3d>& locations, double voxel)
{
  auto accessor = grid.getAccessor();
  for (const Eigen::Vector3d& location : locations)
    for (int k = 0; k < 8; ++k)
    {
      const openvdb::Coord at(static_cast<int>(std::floor(location.x() / voxel)) + (k & 1),
                              static_cast<int>(std::floor(location.y() / voxel)) + (k >> 1 & 1),
                              static_cast<int>(std::floor(location.z() / voxel)) + (k >> 2 & 1));
      if (accessor.getValue(at) < kOutside)
        accessor.setValue(at, kOutside);
    }
}

}  // namespace

UnitedSurface unite(const geometry::TriangleMesh& triangles, double voxel)
{
  openvdb::initialize();
  const openvdb::FloatGrid::Ptr grid = signedDistance(triangles, voxel);
  UnitedSurface united;
  for (int round = 0; round < kMaxSeparationRounds; ++round)
  {
    united.mesh = zeroLevel(*grid, voxel);
    if (united.mesh.triangles.empty())
      throw InputError("mesh", "", "the triangles enclose no volume; close the holes, or check the unit");
    const std::vector<Eigen::Vector3d> locations = nonManifoldLocations(united.mesh);
    if (locations.empty())
      return united;
    separateSheets(*grid, locations, voxel);
    united.separated.insert(united.separated.end(), locations.begin(), locations.end());
  }
  throw InputError("mesh", "", "sheets of the wall touch at this voxel size; specify another --voxel");
}

}  // namespace endovascular_sim::vessel
