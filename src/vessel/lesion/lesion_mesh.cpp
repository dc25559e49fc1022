#include "vessel/lesion/lesion_mesh.h"

#include <algorithm>
#include <array>
#include <vector>

#include <Eigen/Geometry>

#include "geometry/mesh_distance.h"
#include "geometry/vertex_normals.h"
#include "vessel/repair/editable_mesh.h"
#include "vessel/repair/remesh.h"

namespace endovascular_sim::vessel
{
namespace
{

constexpr int kRemeshRounds = 4;
constexpr double kDifference = 0.05;    // step of the finite differences, in edge lengths
constexpr double kLongestFacet = 0.25;  // longest edge before narrowing, relative to the lesion's length
constexpr double kStage = 0.35;         // remaining fraction of the diameter per stage of narrowing

/** Index of a triangle's longest edge. */
int longestSide(const EditableMesh& mesh, int triangle, double& length)
{
  const Eigen::Vector3i& c = mesh.triangle(triangle);
  int longest = 0;
  length = -1.0;
  for (int k = 0; k < 3; ++k)
  {
    const double side = (mesh.position(c[(k + 1) % 3]) - mesh.position(c[k])).norm();
    if (side > length)
      length = side, longest = k;
  }
  return longest;
}

/** Splits the terminal edge of a triangle's longest-edge propagation path; avoids slivers (M. C. Rivara, "New
 *  longest-edge algorithms for the refinement and/or improvement of unstructured triangulations", 1997). */
void splitTowards(EditableMesh& mesh, int triangle)
{
  double length = 0.0;
  for (int longest = longestSide(mesh, triangle, length);;)
  {
    const int a = mesh.triangle(triangle)[longest];
    const int b = mesh.triangle(triangle)[(longest + 1) % 3];
    const std::array<int, 2> sides = mesh.trianglesAt(a, b);
    const int next = sides[0] == triangle ? sides[1] : sides[0];
    double next_length = 0.0;
    const int next_longest = longestSide(mesh, next, next_length);
    if (!(next_length > length))
    {
      mesh.split(a, b, 0.5 * (mesh.position(a) + mesh.position(b)));
      return;
    }
    triangle = next, longest = next_longest, length = next_length;
  }
}

/** Refines facets near a lesion that are long relative to it. The surface is unchanged. */
geometry::TriangleMesh refineLongFacets(const geometry::TriangleMesh& mesh, const LesionShape& shape, double length)
{
  EditableMesh edit(mesh);
  for (bool any = true; any;)
  {
    any = false;
    const int count = edit.triangleCount();
    for (int t = 0; t < count; ++t)
    {
      double side = 0.0;
      const int k = longestSide(edit, t, side);
      const Eigen::Vector3i& c = edit.triangle(t);
      if (side <= kLongestFacet * length ||
          !shape.affects(0.5 * (edit.position(c[k]) + edit.position(c[(k + 1) % 3])), side))
        continue;
      splitTowards(edit, t);
      any = true;
    }
  }
  return edit.compact();
}

/** Vertices that a lesion moves: the vertices within it that are connected to the one nearest to the axis. Adjacent
 *  vessels are thereby excluded.
 *  @param healthy position of each vertex on the healthy wall [m] */
std::vector<char> verticesWithin(const geometry::TriangleMesh& mesh, const std::vector<Eigen::Vector3d>& healthy,
                                 const LesionShape& shape)
{
  const std::size_t n = mesh.vertices.size();
  std::vector<char> within(n);
  std::size_t first = n;
  double nearest = 1e300;
  for (std::size_t v = 0; v < n; ++v)
  {
    within[v] = shape.map(healthy[v]).narrowing > 0.0 ? 1 : 0;
    const double radii = within[v] != 0 ? shape.foot(mesh.vertices[v]).radii : nearest;
    if (radii < nearest)
      nearest = radii, first = v;
  }
  std::vector<char> selected(n, 0);
  const EditableMesh topology(mesh);
  std::vector<int> open;
  if (first < n)
    open.push_back(static_cast<int>(first));
  while (!open.empty())
  {
    const int v = open.back();
    open.pop_back();
    if (selected[static_cast<std::size_t>(v)] != 0)
      continue;
    selected[static_cast<std::size_t>(v)] = 1;
    for (int next : topology.neighbours(v))
      if (within[static_cast<std::size_t>(next)] != 0)
        open.push_back(next);
  }
  return selected;
}

/** Mesh of the triangles with a selected vertex and of their neighbours. It contains the whole wall of the lesion and
 *  retains all vertices. */
geometry::TriangleMesh patchOf(const geometry::TriangleMesh& mesh, const std::vector<char>& selected)
{
  geometry::TriangleMesh patch;
  patch.vertices = mesh.vertices;
  const auto touches = [](const std::vector<char>& marked, const Eigen::Vector3i& t)
  {
    return marked[static_cast<std::size_t>(t[0])] != 0 || marked[static_cast<std::size_t>(t[1])] != 0 ||
           marked[static_cast<std::size_t>(t[2])] != 0;
  };
  std::vector<char> wide = selected;
  for (const Eigen::Vector3i& t : mesh.triangles)
    if (touches(selected, t))
      for (int k = 0; k < 3; ++k)
        wide[static_cast<std::size_t>(t[k])] = 1;
  for (const Eigen::Vector3i& t : mesh.triangles)
    if (touches(wide, t))
      patch.triangles.push_back(t);
  return patch;
}

/** Remeshing target given by the healthy wall and the map of the lesion. */
class LesionTarget : public RemeshTarget
{
public:
  LesionTarget(const geometry::TriangleMesh& healthy, const LesionShape& shape)
    : healthy_(healthy), distance_(healthy), normals_(geometry::vertexNormals(healthy)), shape_(shape)
  {
  }

  /** The edge length is 0 outside the lesion. */
  TargetPoint project(const Eigen::Vector3d& p) const override
  {
    const geometry::ClosestPoint at = healthyPoint(shape_.inverse(p));
    const LesionShape::Image image = shape_.map(at.point);
    const Eigen::Vector3d normal = geometry::normalAt(healthy_, normals_, at).normalized();
    if (!(image.narrowing > 0.0))
      return {p, normal, 0.0};
    // The normal is the cross product of the mapped tangents.
    const double h = kDifference * image.edge_length;
    const Eigen::Vector3d u = normal.unitOrthogonal();
    const Eigen::Vector3d v = normal.cross(u);
    const auto along = [&](const Eigen::Vector3d& d)
    { return Eigen::Vector3d(shape_.map(at.point + h * d).position - shape_.map(at.point - h * d).position); };
    return {image.position, along(u).cross(along(v)).normalized(), image.edge_length};
  }

private:
  /** Radial projection from the axis onto the healthy wall; injective in spite of creases. At a side branch, the
   *  closest point is used instead. */
  geometry::ClosestPoint healthyPoint(const Eigen::Vector3d& p) const
  {
    const LesionShape::Foot foot = shape_.foot(p);
    if (!(foot.distance > 0.0))
      return distance_.closest(p);
    const Eigen::Vector3d outward = (p - foot.point) / foot.distance;
    const double reach = distance_.rayHit(foot.point, outward);
    const bool own_wall = reach > 0.0 && reach * foot.radii <= LesionShape::kFullReach * foot.distance;
    return distance_.closest(own_wall ? Eigen::Vector3d(foot.point + reach * outward) : p);
  }

  const geometry::TriangleMesh& healthy_;
  geometry::MeshDistance distance_;
  std::vector<Eigen::Vector3d> normals_;
  const LesionShape& shape_;
};

}  // namespace

geometry::TriangleMesh narrowedMesh(geometry::TriangleMesh mesh, const CentrelineBranch& branch, const Lesion& lesion,
                                    double middle)
{
  Lesion stage = lesion;
  mesh = refineLongFacets(mesh, LesionShape(branch, lesion, middle), lesion.length);
  std::vector<Eigen::Vector3d> healthy = mesh.vertices;
  std::vector<char> selected = verticesWithin(mesh, healthy, LesionShape(branch, lesion, middle));
  const geometry::TriangleMesh patch = patchOf(mesh, selected);
  double left = 1.0;
  for (bool last = !(lesion.grade > 0.0); !last;)
  {
    left *= kStage;
    last = left <= 1.0 - lesion.grade;
    stage.grade = last ? lesion.grade : 1.0 - left;
    const LesionShape shape(branch, stage, middle);
    for (std::size_t v = 0; v < mesh.vertices.size(); ++v)
      if (selected[v] != 0)
        mesh.vertices[v] = shape.map(healthy[v]).position;
    mesh = remeshRegion(mesh, LesionTarget(patch, shape), selected, kRemeshRounds);
    if (last)
      break;
    healthy.clear();
    for (const Eigen::Vector3d& p : mesh.vertices)
      healthy.push_back(shape.inverse(p));
    selected = verticesWithin(mesh, healthy, shape);
  }
  return mesh;
}

bool hasFoldedFaces(const geometry::TriangleMesh& mesh, const geometry::TriangleMesh& healthy, const LesionShape& shape)
{
  const LesionTarget wall(healthy, shape);
  for (const Eigen::Vector3i& t : mesh.triangles)
  {
    const Eigen::Vector3d& a = mesh.vertices[t[0]];
    const Eigen::Vector3d middle = (a + mesh.vertices[t[1]] + mesh.vertices[t[2]]) / 3.0;
    const LesionShape::Foot foot = shape.foot(middle);
    if (shape.narrowingAt(foot.from_middle) <= 0.0 || foot.radii > 1.0)
      continue;
    const Eigen::Vector3d normal = (mesh.vertices[t[1]] - a).cross(mesh.vertices[t[2]] - a);
    if (normal.dot(wall.project(middle).normal) <= 0.0)
      return true;
  }
  return false;
}

}  // namespace endovascular_sim::vessel
