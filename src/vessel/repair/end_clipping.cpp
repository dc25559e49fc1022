#include "vessel/repair/end_clipping.h"

#include <algorithm>
#include <map>
#include <queue>
#include <vector>

#include <Eigen/Geometry>

#include "common/error.h"
#include "vessel/repair/mesh_check.h"

namespace endovascular_sim::vessel
{
namespace
{

/** Snapping distance to the plane, relative to the shortest edge of a vertex. */
constexpr double kSnap = 0.25;

/** Clips the end of a vessel at a plane. */
class Clipper
{
public:
  Clipper(const geometry::TriangleMesh& mesh, const ClipPlane& plane, const std::string& source)
    : mesh_(mesh), plane_(plane), source_(source), neighbours_(mesh.vertices.size())
  {
    for (const Eigen::Vector3i& t : mesh.triangles)
      for (int k = 0; k < 3; ++k)
        for (int other : {(k + 1) % 3, (k + 2) % 3})
          neighbours_[static_cast<std::size_t>(t[k])].push_back(t[other]);
  }

  geometry::TriangleMesh run()
  {
    for (const Eigen::Vector3d& v : mesh_.vertices)
      height_.push_back((v - plane_.point).dot(plane_.outward));
    markBeyond();
    snap();
    geometry::TriangleMesh result;
    result.vertices = mesh_.vertices;
    for (const Eigen::Vector3i& t : mesh_.triangles)
      clip(t, result);
    return dropUnusedVertices(result);
  }

private:
  double height(int v) const { return height_[static_cast<std::size_t>(v)]; }
  bool beyond(int v) const { return beyond_[static_cast<std::size_t>(v)]; }

  /** Marks the vertices beyond the plane that are connected to the tip. */
  void markBeyond()
  {
    int seed = -1;
    double nearest = 1e300;
    for (std::size_t v = 0; v < mesh_.vertices.size(); ++v)
    {
      const double distance = (mesh_.vertices[v] - plane_.point).norm();
      if (height_[v] > 0.0 && distance < nearest)
      {
        nearest = distance;
        seed = static_cast<int>(v);
      }
    }
    beyond_.assign(mesh_.vertices.size(), false);
    if (seed < 0)
      reject("lies beyond the vessel");
    std::queue<int> open;
    beyond_[static_cast<std::size_t>(seed)] = true;
    for (open.push(seed); !open.empty(); open.pop())
    {
      const auto v = static_cast<std::size_t>(open.front());
      if ((mesh_.vertices[v] - plane_.point).norm() > plane_.max_distance)
        reject("would remove more than this end");
      for (int n : neighbours_[v])
        if (height(n) > 0.0 && !beyond(n))
        {
          beyond_[static_cast<std::size_t>(n)] = true;
          open.push(n);
        }
    }
  }

  /** Snaps vertices next to the cut onto the plane. */
  void snap()
  {
    const std::vector<bool> was_beyond = beyond_;
    for (std::size_t v = 0; v < mesh_.vertices.size(); ++v)
    {
      bool at_cut = false;
      double shortest = 1e300;
      for (int n : neighbours_[v])
      {
        at_cut = at_cut || was_beyond[static_cast<std::size_t>(n)] != was_beyond[v];
        shortest = std::min(shortest, (mesh_.vertices[static_cast<std::size_t>(n)] - mesh_.vertices[v]).norm());
      }
      if (!at_cut || std::abs(height_[v]) > kSnap * shortest)
        continue;
      mesh_.vertices[v] -= height_[v] * plane_.outward;
      height_[v] = 0.0;
      beyond_[v] = false;
    }
  }

  [[noreturn]] void reject(const std::string& reason) const
  {
    throw InputError(source_, "--open",
                     "the plane at " + formatLocation(plane_.point) + " " + reason +
                         "; specify another --cut-back, or omit the end");
  }

  /** Vertex at the intersection of the plane with the edge from a retained to a removed vertex. */
  int intersection(int kept, int removed, geometry::TriangleMesh& result)
  {
    const auto [entry, is_new] = cuts_.try_emplace({kept, removed}, static_cast<int>(result.vertices.size()));
    if (is_new)
    {
      const double t = height(kept) / (height(kept) - height(removed));
      const Eigen::Vector3d& a = mesh_.vertices[static_cast<std::size_t>(kept)];
      const Eigen::Vector3d& b = mesh_.vertices[static_cast<std::size_t>(removed)];
      result.vertices.emplace_back(a + t * (b - a));
    }
    return entry->second;
  }

  /** Appends the part of a triangle on the inner side of the plane. */
  void clip(const Eigen::Vector3i& t, geometry::TriangleMesh& result)
  {
    if (!beyond(t[0]) && !beyond(t[1]) && !beyond(t[2]))
    {
      result.triangles.push_back(t);
      return;
    }
    std::vector<int> corners;
    for (int k = 0; k < 3; ++k)
    {
      const int a = t[k];
      const int b = t[(k + 1) % 3];
      if (!beyond(a))
        corners.push_back(a);
      if (beyond(a) != beyond(b) && height(beyond(a) ? b : a) < 0.0)
        corners.push_back(beyond(a) ? intersection(b, a, result) : intersection(a, b, result));
    }
    for (std::size_t k = 1; k + 1 < corners.size(); ++k)
      result.triangles.emplace_back(corners[0], corners[k], corners[k + 1]);
  }

  static geometry::TriangleMesh dropUnusedVertices(const geometry::TriangleMesh& mesh)
  {
    geometry::TriangleMesh result;
    std::vector<int> index(mesh.vertices.size(), -1);
    for (Eigen::Vector3i t : mesh.triangles)
    {
      for (int k = 0; k < 3; ++k)
      {
        int& to = index[static_cast<std::size_t>(t[k])];
        if (to < 0)
        {
          to = static_cast<int>(result.vertices.size());
          result.vertices.push_back(mesh.vertices[static_cast<std::size_t>(t[k])]);
        }
        t[k] = to;
      }
      result.triangles.push_back(t);
    }
    return result;
  }

  geometry::TriangleMesh mesh_;
  ClipPlane plane_;
  std::string source_;
  std::vector<std::vector<int>> neighbours_;
  std::vector<double> height_;
  std::vector<bool> beyond_;
  std::map<std::pair<int, int>, int> cuts_;
};

}  // namespace

geometry::TriangleMesh clipEnd(const geometry::TriangleMesh& mesh, const ClipPlane& plane, const std::string& source)
{
  return Clipper(mesh, plane, source).run();
}

}  // namespace endovascular_sim::vessel
