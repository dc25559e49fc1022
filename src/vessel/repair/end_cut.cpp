#include "vessel/repair/end_cut.h"

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

/** A vertex closer to the plane than this fraction of its shortest edge is moved onto it. */
constexpr double kSnap = 0.25;

class Cutter
{
public:
  Cutter(const geometry::TriangleMesh& mesh, const EndCut& cut, const std::string& source)
    : mesh_(mesh), cut_(cut), source_(source), neighbours_(mesh.vertices.size())
  {
    for (const Eigen::Vector3i& t : mesh.triangles)
      for (int k = 0; k < 3; ++k)
        for (int other : {(k + 1) % 3, (k + 2) % 3})
          neighbours_[static_cast<std::size_t>(t[k])].push_back(t[other]);
  }

  geometry::TriangleMesh run()
  {
    for (const Eigen::Vector3d& v : mesh_.vertices)
      height_.push_back((v - cut_.place).dot(cut_.outward));
    markBeyond();
    snap();
    geometry::TriangleMesh result;
    result.vertices = mesh_.vertices;
    for (const Eigen::Vector3i& t : mesh_.triangles)
      clip(t, result);
    return withoutUnused(result);
  }

private:
  double height(int v) const { return height_[static_cast<std::size_t>(v)]; }
  bool beyond(int v) const { return beyond_[static_cast<std::size_t>(v)]; }

  /** The vertices beyond the plane that hang together with the tip. */
  void markBeyond()
  {
    int seed = -1;
    double nearest = 1e300;
    for (std::size_t v = 0; v < mesh_.vertices.size(); ++v)
    {
      const double distance = (mesh_.vertices[v] - cut_.place).norm();
      if (height_[v] > 0.0 && distance < nearest)
      {
        nearest = distance;
        seed = static_cast<int>(v);
      }
    }
    beyond_.assign(mesh_.vertices.size(), false);
    if (seed < 0)
      refuse("lies beyond the vessel");
    std::queue<int> open;
    beyond_[static_cast<std::size_t>(seed)] = true;
    for (open.push(seed); !open.empty(); open.pop())
    {
      const auto v = static_cast<std::size_t>(open.front());
      if ((mesh_.vertices[v] - cut_.place).norm() > cut_.reach)
        refuse("would cut off more than this end");
      for (int n : neighbours_[v])
        if (height(n) > 0.0 && !beyond(n))
        {
          beyond_[static_cast<std::size_t>(n)] = true;
          open.push(n);
        }
    }
  }

  /** Moves what is close to the plane onto it, at the cut only. */
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
      mesh_.vertices[v] -= height_[v] * cut_.outward;
      height_[v] = 0.0;
      beyond_[v] = false;
    }
  }

  [[noreturn]] void refuse(const std::string& reason) const
  {
    throw InputError(
        source_, "--open",
        "the plane at " + formatPlace(cut_.place) + " " + reason + "; give another --cut-back, or leave it out");
  }

  /** Vertex where the edge from a kept to a cut vertex meets the plane. */
  int onPlane(int kept, int gone, geometry::TriangleMesh& result)
  {
    const auto [entry, is_new] = cuts_.try_emplace({kept, gone}, static_cast<int>(result.vertices.size()));
    if (is_new)
    {
      const double share = height(kept) / (height(kept) - height(gone));
      const Eigen::Vector3d& a = mesh_.vertices[static_cast<std::size_t>(kept)];
      const Eigen::Vector3d& b = mesh_.vertices[static_cast<std::size_t>(gone)];
      result.vertices.emplace_back(a + share * (b - a));
    }
    return entry->second;
  }

  /** Appends what the plane leaves of a triangle. */
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
        corners.push_back(beyond(a) ? onPlane(b, a, result) : onPlane(a, b, result));
    }
    for (std::size_t k = 1; k + 1 < corners.size(); ++k)
      result.triangles.emplace_back(corners[0], corners[k], corners[k + 1]);
  }

  static geometry::TriangleMesh withoutUnused(const geometry::TriangleMesh& mesh)
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
  EndCut cut_;
  std::string source_;
  std::vector<std::vector<int>> neighbours_;
  std::vector<double> height_;
  std::vector<bool> beyond_;
  std::map<std::pair<int, int>, int> cuts_;
};

}  // namespace

geometry::TriangleMesh cutEnd(const geometry::TriangleMesh& mesh, const EndCut& cut, const std::string& source)
{
  return Cutter(mesh, cut, source).run();
}

}  // namespace endovascular_sim::vessel
