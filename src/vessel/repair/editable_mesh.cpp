#include "vessel/repair/editable_mesh.h"

#include <algorithm>

#include <Eigen/Geometry>

namespace endovascular_sim::vessel
{

EditableMesh::EditableMesh(const geometry::TriangleMesh& mesh)
  : positions_(mesh.vertices), triangles_(mesh.triangles), around_(mesh.vertices.size())
{
  for (std::size_t t = 0; t < triangles_.size(); ++t)
    for (int k = 0; k < 3; ++k)
      around_[static_cast<std::size_t>(triangles_[t][k])].push_back(static_cast<int>(t));
}

geometry::TriangleMesh EditableMesh::compact() const
{
  geometry::TriangleMesh mesh;
  std::vector<int> index(positions_.size(), -1);
  for (std::size_t v = 0; v < positions_.size(); ++v)
    if (!around_[v].empty())
    {
      index[v] = static_cast<int>(mesh.vertices.size());
      mesh.vertices.push_back(positions_[v]);
    }
  for (const Eigen::Vector3i& t : triangles_)
    if (t[0] >= 0)
      mesh.triangles.emplace_back(index[static_cast<std::size_t>(t[0])], index[static_cast<std::size_t>(t[1])],
                                  index[static_cast<std::size_t>(t[2])]);
  return mesh;
}

std::vector<int> EditableMesh::neighbours(int v) const
{
  std::vector<int> out;
  for (int t : around(v))
    for (int k = 0; k < 3; ++k)
      if (triangle(t)[k] != v)
        out.push_back(triangle(t)[k]);
  std::sort(out.begin(), out.end());
  out.erase(std::unique(out.begin(), out.end()), out.end());
  return out;
}

std::array<int, 2> EditableMesh::trianglesAt(int a, int b) const
{
  std::array<int, 2> found{-1, -1};
  std::size_t count = 0;
  for (int t : around(a))
    if ((triangle(t).array() == b).any() && count < 2)
      found[count++] = t;
  return found;
}

int EditableMesh::opposite(int t, int a, int b) const
{
  const Eigen::Vector3i& corners = triangle(t);
  for (int k = 0; k < 3; ++k)
    if (corners[k] != a && corners[k] != b)
      return corners[k];
  return -1;
}

int EditableMesh::split(int a, int b, const Eigen::Vector3d& p)
{
  const std::array<int, 2> sides = trianglesAt(a, b);
  const int middle = vertexCount();
  positions_.push_back(p);
  around_.emplace_back();
  for (int t : sides)
  {
    const Eigen::Vector3i whole = triangle(t);
    Eigen::Vector3i near_a = whole;
    Eigen::Vector3i near_b = whole;
    for (int k = 0; k < 3; ++k)
    {
      if (whole[k] == b)
        near_a[k] = middle;
      if (whole[k] == a)
        near_b[k] = middle;
    }
    setTriangle(t, near_a);
    const int added = triangleCount();
    triangles_.emplace_back(-1, -1, -1);
    setTriangle(added, near_b);
  }
  return middle;
}

bool EditableMesh::canCollapse(int a, int b) const
{
  const std::vector<int> of_a = neighbours(a);
  const std::vector<int> of_b = neighbours(b);
  std::vector<int> common;
  std::set_intersection(of_a.begin(), of_a.end(), of_b.begin(), of_b.end(), std::back_inserter(common));
  if (common.size() != 2)
    return false;
  // A vertex of valence three would be left with two coincident triangles.
  return degree(common[0]) > 3 && degree(common[1]) > 3 && degree(a) > 3 && degree(b) > 3;
}

void EditableMesh::collapse(int a, int b, const Eigen::Vector3d& p)
{
  for (int t : trianglesAt(a, b))
    removeTriangle(t);
  const std::vector<int> moved = around(a);
  for (int t : moved)
  {
    Eigen::Vector3i corners = triangle(t);
    for (int k = 0; k < 3; ++k)
      if (corners[k] == a)
        corners[k] = b;
    setTriangle(t, corners);
  }
  move(b, p);
}

bool EditableMesh::flip(int a, int b)
{
  const std::array<int, 2> sides = trianglesAt(a, b);
  const int c = opposite(sides[0], a, b);
  const int d = opposite(sides[1], a, b);
  if (degree(a) <= 3 || degree(b) <= 3 || trianglesAt(c, d)[0] >= 0)
    return false;
  Eigen::Vector3i first = triangle(sides[0]);
  Eigen::Vector3i second = triangle(sides[1]);
  for (int k = 0; k < 3; ++k)
  {
    if (first[k] == b)
      first[k] = d;
    if (second[k] == a)
      second[k] = c;
  }
  setTriangle(sides[0], first);
  setTriangle(sides[1], second);
  return true;
}

Eigen::Vector3d EditableMesh::areaNormal(int t, int moved, const Eigen::Vector3d& p) const
{
  const auto at = [&](int k)
  {
    const int v = triangle(t)[k];
    return v == moved ? p : position(v);
  };
  const Eigen::Vector3d a = at(0);
  return (at(1) - a).cross(at(2) - a);
}

void EditableMesh::setTriangle(int t, const Eigen::Vector3i& corners)
{
  Eigen::Vector3i& old = triangles_[static_cast<std::size_t>(t)];
  for (int k = 0; k < 3; ++k)
    if (old[k] >= 0 && !(corners.array() == old[k]).any())
      detach(t, old[k]);
  for (int k = 0; k < 3; ++k)
    if (!(old.array() == corners[k]).any())
      around_[static_cast<std::size_t>(corners[k])].push_back(t);
  old = corners;
}

void EditableMesh::detach(int t, int v)
{
  std::vector<int>& list = around_[static_cast<std::size_t>(v)];
  list.erase(std::find(list.begin(), list.end(), t));
}

void EditableMesh::removeTriangle(int t)
{
  Eigen::Vector3i& corners = triangles_[static_cast<std::size_t>(t)];
  for (int k = 0; k < 3; ++k)
    detach(t, corners[k]);
  corners.setConstant(-1);
}

}  // namespace endovascular_sim::vessel
