#include "vessel/anatomy/iso_surface.h"

#include <algorithm>
#include <array>
#include <cmath>

#include <Eigen/Geometry>

#include "geometry/edge_table.h"

namespace endovascular_sim::vessel
{
namespace
{

/** Edge of the initial cubes [m]. */
constexpr double kCube = 16e-3;
/** Longest edge of a tetrahedron that intersects the wall, in target edge lengths. */
constexpr double kCoarseness = 2.0;
/** Lipschitz constant of the field: the wall is at least |distance|/kSteepest away from a point. */
constexpr double kSteepest = 1.3;
/** Minimum distance of an intersection from the ends of its edge, as a fraction of the edge. */
constexpr double kCornerMargin = 0.03;

/** Tetrahedron in Maubach's vertex order: its refinement edge joins corner 0 and corner `tag`. */
struct Tetrahedron
{
  std::array<int, 4> corner;
  int tag = 3;
};

/** Adaptive tetrahedral grid around the zero level of a field. */
class TetrahedralGrid
{
public:
  explicit TetrahedralGrid(const ImplicitVessel& field) : field_(field)
  {
    seed();
    refineNearWall();
    makeConforming();
  }

  geometry::TriangleMesh surface();

private:
  struct Vertex
  {
    Eigen::Vector3d position;
    double distance;
    double edge_length;
  };

  const Vertex& at(int v) const { return vertices_[static_cast<std::size_t>(v)]; }

  int addVertex(const Eigen::Vector3d& p)
  {
    const FieldSample sample = field_.at(p);
    vertices_.push_back({p, sample.distance, sample.edge_length});
    return static_cast<int>(vertices_.size()) - 1;
  }

  void seed();
  void refineNearWall();
  void makeConforming();

  double longestEdge(const Tetrahedron& t) const
  {
    double longest = 0.0;
    for (int i = 0; i < 4; ++i)
      for (int j = i + 1; j < 4; ++j)
        longest = std::max(longest, (position(t, i) - position(t, j)).norm());
    return longest;
  }

  const Eigen::Vector3d& position(const Tetrahedron& t, int i) const
  {
    return at(t.corner[static_cast<std::size_t>(i)]).position;
  }

  /** False if the values at the corners exclude that the wall intersects the tetrahedron. */
  bool nearWall(const Tetrahedron& t, double longest) const
  {
    double min_distance = 1e300;
    int inside = 0;
    for (int v : t.corner)
    {
      min_distance = std::min(min_distance, std::abs(at(v).distance));
      inside += at(v).distance < 0.0 ? 1 : 0;
    }
    return (inside > 0 && inside < 4) || min_distance < 0.7 * kSteepest * longest;
  }

  bool tooCoarse(const Tetrahedron& t) const
  {
    const double longest = longestEdge(t);
    double edge_length = 1e300;
    for (int v : t.corner)
      edge_length = std::min(edge_length, at(v).edge_length);
    return longest > kCoarseness * edge_length && nearWall(t, longest);
  }

  bool hasHangingVertex(const Tetrahedron& t) const
  {
    for (std::size_t i = 0; i < 4; ++i)
      for (std::size_t j = i + 1; j < 4; ++j)
        if (midpoints_.find(t.corner[i], t.corner[j]) >= 0)
          return true;
    return false;
  }

  std::array<Tetrahedron, 2> bisect(const Tetrahedron& t);

  const ImplicitVessel& field_;
  std::vector<Vertex> vertices_;
  std::vector<Tetrahedron> leaves_;
  geometry::EdgeTable midpoints_;
};

/** Kuhn subdivision of every cube into six tetrahedra: a valid initial mesh of Maubach's bisection. */
void TetrahedralGrid::seed()
{
  const Eigen::Vector3d origin = field_.bounds().min() - Eigen::Vector3d::Constant(kCube);
  Eigen::Vector3i count;
  for (int i = 0; i < 3; ++i)
    count[i] = static_cast<int>(std::ceil(field_.bounds().sizes()[i] / kCube)) + 2;
  const auto index = [&count](const Eigen::Vector3i& c)
  { return (c.z() * (count.y() + 1) + c.y()) * (count.x() + 1) + c.x(); };
  for (int z = 0; z <= count.z(); ++z)
    for (int y = 0; y <= count.y(); ++y)
      for (int x = 0; x <= count.x(); ++x)
        addVertex(origin + kCube * Eigen::Vector3d(x, y, z));
  for (int z = 0; z < count.z(); ++z)
    for (int y = 0; y < count.y(); ++y)
      for (int x = 0; x < count.x(); ++x)
      {
        std::array<int, 3> axes{0, 1, 2};
        do
        {
          Tetrahedron t;
          Eigen::Vector3i corner(x, y, z);
          t.corner[0] = index(corner);
          for (std::size_t k = 0; k < 3; ++k)
          {
            ++corner[axes[k]];
            t.corner[k + 1] = index(corner);
          }
          leaves_.push_back(t);
        } while (std::next_permutation(axes.begin(), axes.end()));
      }
}

std::array<Tetrahedron, 2> TetrahedralGrid::bisect(const Tetrahedron& t)
{
  const auto tag = static_cast<std::size_t>(t.tag);
  const int a = t.corner[0];
  const int b = t.corner[tag];
  int middle = midpoints_.find(a, b);
  if (middle < 0)
  {
    middle = addVertex(0.5 * (at(a).position + at(b).position));
    midpoints_.insert(a, b, middle);
  }
  // (v0 … v(k−1), z, v(k+1) …) and (v1 … vk, z, v(k+1) …)
  Tetrahedron first = t;
  first.corner[tag] = middle;
  Tetrahedron second = t;
  for (std::size_t k = 0; k < tag; ++k)
    second.corner[k] = t.corner[k + 1];
  second.corner[tag] = middle;
  first.tag = second.tag = t.tag > 1 ? t.tag - 1 : 3;
  return {first, second};
}

void TetrahedralGrid::refineNearWall()
{
  std::vector<Tetrahedron> open;
  open.swap(leaves_);
  while (!open.empty())
  {
    const Tetrahedron t = open.back();
    open.pop_back();
    if (!tooCoarse(t))
    {
      leaves_.push_back(t);
      continue;
    }
    for (const Tetrahedron& half : bisect(t))
      open.push_back(half);
  }
}

/** Bisects tetrahedra with hanging vertices until none is left near the wall. */
void TetrahedralGrid::makeConforming()
{
  for (bool changed = true; changed;)
  {
    changed = false;
    std::vector<Tetrahedron> open;
    open.swap(leaves_);
    while (!open.empty())
    {
      const Tetrahedron t = open.back();
      open.pop_back();
      if (!nearWall(t, longestEdge(t)))
        continue;  // contains no part of the surface
      if (!hasHangingVertex(t))
      {
        leaves_.push_back(t);
        continue;
      }
      changed = true;
      for (const Tetrahedron& half : bisect(t))
        open.push_back(half);
    }
  }
}

geometry::TriangleMesh TetrahedralGrid::surface()
{
  geometry::TriangleMesh mesh;
  geometry::EdgeTable cuts;
  const auto cut = [&](int inside, int outside)
  {
    int v = cuts.find(inside, outside);
    if (v >= 0)
      return v;
    const double in = at(inside).distance;
    const double fraction = std::clamp(in / (in - at(outside).distance), kCornerMargin, 1.0 - kCornerMargin);
    v = static_cast<int>(mesh.vertices.size());
    mesh.vertices.emplace_back(at(inside).position + fraction * (at(outside).position - at(inside).position));
    cuts.insert(inside, outside, v);
    return v;
  };
  const auto add = [&mesh](int a, int b, int c, const Eigen::Vector3d& outward)
  {
    const auto p = [&mesh](int v) { return mesh.vertices[static_cast<std::size_t>(v)]; };
    if ((p(b) - p(a)).cross(p(c) - p(a)).dot(outward) < 0.0)
      std::swap(b, c);
    mesh.triangles.emplace_back(a, b, c);
  };
  for (const Tetrahedron& t : leaves_)
  {
    std::vector<int> in;
    std::vector<int> out;
    Eigen::Vector3d outward = Eigen::Vector3d::Zero();
    for (int v : t.corner)
      (at(v).distance < 0.0 ? in : out).push_back(v);
    if (in.empty() || out.empty())
      continue;
    for (int v : out)
      outward += at(v).position / static_cast<double>(out.size());
    for (int v : in)
      outward -= at(v).position / static_cast<double>(in.size());
    if (in.size() == 1)
      add(cut(in[0], out[0]), cut(in[0], out[1]), cut(in[0], out[2]), outward);
    else if (out.size() == 1)
      add(cut(in[0], out[0]), cut(in[1], out[0]), cut(in[2], out[0]), outward);
    else
    {
      const std::array<int, 4> ring{cut(in[0], out[0]), cut(in[0], out[1]), cut(in[1], out[1]), cut(in[1], out[0])};
      add(ring[0], ring[1], ring[2], outward);
      add(ring[0], ring[2], ring[3], outward);
    }
  }
  return mesh;
}

}  // namespace

geometry::TriangleMesh isoSurface(const ImplicitVessel& field)
{
  return TetrahedralGrid(field).surface();
}

}  // namespace endovascular_sim::vessel
