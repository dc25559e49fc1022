#include "segmentation/surface/lattice_surface.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <unordered_map>
#include <utility>
#include <vector>

#include "geometry/mesh_topology.h"

namespace endovascular_sim::segmentation
{
namespace
{

/** Least magnitude of a lattice value, in spacings, so that no vertex lies on a lattice point. */
constexpr float kLeast = 0.01F;

/** Marching tetrahedra: every cube of the lattice is cut into the six tetrahedra around its diagonal. */
class MarchingTetrahedra
{
public:
  explicit MarchingTetrahedra(const LatticeField& field) : field_(field) {}

  geometry::TriangleMesh run()
  {
    for (const auto& entry : field_.blocks())
      addBlock(entry.first);
    return std::move(mesh_);
  }

private:
  static constexpr int kEdge = LatticeField::kEdge;
  static constexpr int kSide = kEdge + 1;

  void addBlock(const LatticeField::Key& key)
  {
    // Values of the block and of the first layer of its neighbours.
    std::array<float, kSide * kSide * kSide> values{};
    bool inside = false;
    bool outside = false;
    for (int n = 0; n < 8; ++n)
    {
      const int nx = n & 1;
      const int ny = n >> 1 & 1;
      const int nz = n >> 2;
      const auto found = field_.blocks().find({key[0] + nx, key[1] + ny, key[2] + nz});
      for (int c = nz * kEdge; c < (nz > 0 ? kSide : kEdge); ++c)
        for (int b = ny * kEdge; b < (ny > 0 ? kSide : kEdge); ++b)
          for (int a = nx * kEdge; a < (nx > 0 ? kSide : kEdge); ++a)
          {
            float value = LatticeField::kOutside;
            if (found != field_.blocks().end())
              value = found->second[static_cast<std::size_t>((c % kEdge * kEdge + b % kEdge) * kEdge + a % kEdge)];
            const auto least = static_cast<float>(kLeast * field_.spacing());
            if (std::abs(value) < least)
              value = value < 0.0F ? -least : least;
            values[static_cast<std::size_t>((c * kSide + b) * kSide + a)] = value;
            (value < 0.0F ? inside : outside) = true;
          }
    }
    if (!inside || !outside)
      return;
    for (int c = 0; c < kEdge; ++c)
      for (int b = 0; b < kEdge; ++b)
        for (int a = 0; a < kEdge; ++a)
          addCube(key, {a, b, c}, values.data());
  }

  struct Corner
  {
    Eigen::Vector3i at;
    float value;
  };

  void addCube(const LatticeField::Key& key, const Eigen::Vector3i& cell, const float* values)
  {
    static const int kOrders[6][3] = {{0, 1, 2}, {1, 2, 0}, {2, 0, 1}, {0, 2, 1}, {2, 1, 0}, {1, 0, 2}};
    const Eigen::Vector3i origin(key[0] * kEdge, key[1] * kEdge, key[2] * kEdge);
    const auto corner = [&](const Eigen::Vector3i& offset)
    {
      const Eigen::Vector3i p = cell + offset;
      return Corner{origin + p, values[(p.z() * kSide + p.y()) * kSide + p.x()]};
    };
    bool negative = false;
    bool positive = false;
    for (int n = 0; n < 8; ++n)
      (corner({n & 1, n >> 1 & 1, n >> 2}).value < 0.0F ? negative : positive) = true;
    if (!negative || !positive)
      return;
    for (int o = 0; o < 6; ++o)
    {
      std::array<Corner, 4> tetrahedron;
      Eigen::Vector3i offset = Eigen::Vector3i::Zero();
      tetrahedron[0] = corner(offset);
      for (std::size_t k = 0; k < 3; ++k)
      {
        offset[kOrders[o][k]] = 1;
        tetrahedron[k + 1] = corner(offset);
      }
      if (o >= 3)  // the odd permutations are left-handed
        std::swap(tetrahedron[2], tetrahedron[3]);
      addTetrahedron(tetrahedron);
    }
  }

  /** Triangles of a right-handed tetrahedron, with normals out of the negative side. */
  void addTetrahedron(const std::array<Corner, 4>& c)
  {
    static const std::size_t kFaces[4][3] = {{1, 2, 3}, {0, 3, 2}, {0, 1, 3}, {0, 2, 1}};  // opposite to the corner
    int inside = 0;
    for (const Corner& corner : c)
      inside += corner.value < 0.0F ? 1 : 0;
    if (inside == 0 || inside == 4)
      return;
    if (inside == 1 || inside == 3)
    {
      const bool alone_inside = inside == 1;
      std::size_t apex = 0;
      while ((c[apex].value < 0.0F) != alone_inside)
        ++apex;
      const std::size_t* face = kFaces[apex];
      const int a = vertex(c[apex], c[face[0]]);
      const int b = vertex(c[apex], c[face[1]]);
      const int d = vertex(c[apex], c[face[2]]);
      if (alone_inside)
        mesh_.triangles.emplace_back(a, b, d);
      else
        mesh_.triangles.emplace_back(a, d, b);
      return;
    }
    // Two corners p, q inside and r, s outside; p, q, r, s is an even permutation.
    static const std::size_t kPairs[6][4] = {{0, 1, 2, 3}, {0, 2, 3, 1}, {0, 3, 1, 2},
                                             {1, 2, 0, 3}, {1, 3, 2, 0}, {2, 3, 0, 1}};
    for (const std::size_t* pair : kPairs)
    {
      if (c[pair[0]].value >= 0.0F || c[pair[1]].value >= 0.0F)
        continue;
      const int pr = vertex(c[pair[0]], c[pair[2]]);
      const int ps = vertex(c[pair[0]], c[pair[3]]);
      const int qs = vertex(c[pair[1]], c[pair[3]]);
      const int qr = vertex(c[pair[1]], c[pair[2]]);
      mesh_.triangles.emplace_back(pr, qs, qr);
      mesh_.triangles.emplace_back(pr, ps, qs);
      return;
    }
  }

  int vertex(Corner a, Corner b)
  {
    if (std::lexicographical_compare(b.at.data(), b.at.data() + 3, a.at.data(), a.at.data() + 3))
      std::swap(a, b);
    const Eigen::Vector3i step = b.at - a.at;
    constexpr int kHalf = 1 << 19;
    std::uint64_t key = 0;
    for (int axis = 0; axis < 3; ++axis)
      key = key << 20U | static_cast<std::uint64_t>(a.at[axis] + kHalf);
    key = key << 4U | static_cast<std::uint64_t>(step.x() + 2 * step.y() + 4 * step.z() + 7) % 16;
    const auto [entry, is_new] = vertices_.emplace(key, static_cast<int>(mesh_.vertices.size()));
    if (is_new)
    {
      const double t = static_cast<double>(a.value) / (static_cast<double>(a.value) - b.value);
      mesh_.vertices.emplace_back(field_.spacing() * (a.at.cast<double>() + t * step.cast<double>()));
    }
    return entry->second;
  }

  const LatticeField& field_;
  geometry::TriangleMesh mesh_;
  std::unordered_map<std::uint64_t, int> vertices_;
};

/** Component with the most triangles. */
geometry::TriangleMesh largestComponent(const geometry::TriangleMesh& mesh, int* components)
{
  const std::vector<int> name = geometry::triangleComponents(mesh, geometry::sortedHalfEdges(mesh));
  std::unordered_map<int, int> sizes;
  for (const int n : name)
    ++sizes[n];
  int largest = 0;
  for (const int n : name)
    if (sizes[n] > sizes[largest] || sizes[largest] == 0)
      largest = n;
  if (components != nullptr)
    *components = static_cast<int>(sizes.size());
  geometry::TriangleMesh result;
  std::vector<int> number(mesh.vertices.size(), -1);
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
  {
    if (name[t] != largest)
      continue;
    Eigen::Vector3i triangle = mesh.triangles[t];
    for (int k = 0; k < 3; ++k)
    {
      int& n = number[static_cast<std::size_t>(triangle[k])];
      if (n < 0)
      {
        n = static_cast<int>(result.vertices.size());
        result.vertices.push_back(mesh.vertices[static_cast<std::size_t>(triangle[k])]);
      }
      triangle[k] = n;
    }
    result.triangles.push_back(triangle);
  }
  return result;
}

}  // namespace

geometry::TriangleMesh latticeSurface(const LatticeField& field, int* components)
{
  return largestComponent(MarchingTetrahedra(field).run(), components);
}

}  // namespace endovascular_sim::segmentation
