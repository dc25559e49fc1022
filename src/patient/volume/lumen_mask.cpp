#include "patient/volume/lumen_mask.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "patient/tissue/tissue.h"

namespace endovascular_sim::patient
{
namespace
{

constexpr int kSubvoxelBits = 12;
constexpr std::int64_t kSubvoxels = std::int64_t{1} << kSubvoxelBits;
constexpr double kMaxCoordinate = 1 << 29;  // products of coordinate differences fit into 62 bits

struct Corner
{
  std::int64_t y = 0;  // [1/4096 voxel]
  std::int64_t z = 0;  // [1/4096 voxel]
  double x = 0.0;      // [voxel]
};

/** Crossing of a line of voxels with the surface. */
struct Crossing
{
  std::size_t line = 0;  // y + size_y·z
  double x = 0.0;        // [voxel]
  int sign = 0;          // +1: the line enters the mesh
};

Corner cornerOf(const image::VolumeGrid& grid, const Eigen::Vector3d& vertex)
{
  const Eigen::Vector3d c = grid.index(vertex);
  const auto fixed = [](double value)
  { return std::llround(std::clamp(value * kSubvoxels, -kMaxCoordinate, kMaxCoordinate)); };
  return {fixed(c.y()), fixed(c.z()), c.x()};
}

/** Twice the signed area of the triangle (a, b, (y, z)). */
std::int64_t edgeFunction(const Corner& a, const Corner& b, std::int64_t y, std::int64_t z)
{
  return (b.y - a.y) * (z - a.z) - (b.z - a.z) * (y - a.y);
}

/** 0 if samples exactly on the edge a → b belong to the triangle, else 1: a shift of all samples by (ε, ε²). */
std::int64_t edgeBias(const Corner& a, const Corner& b)
{
  return b.z < a.z || (b.z == a.z && b.y > a.y) ? 0 : 1;
}

int firstLine(std::int64_t value)
{
  return static_cast<int>((std::max<std::int64_t>(value, 0) + kSubvoxels - 1) >> kSubvoxelBits);
}

int lastLine(std::int64_t value, int lines)
{
  return value < 0 ? -1 : static_cast<int>(std::min<std::int64_t>(value >> kSubvoxelBits, lines - 1));
}

void addTriangle(Corner a, Corner b, Corner c, const image::VolumeGrid& grid, std::vector<Crossing>& crossings)
{
  const std::int64_t area = edgeFunction(a, b, c.y, c.z);
  if (area == 0)
    return;
  const int sign = area < 0 ? 1 : -1;  // an outward normal towards −x: the line enters
  if (area < 0)
    std::swap(b, c);
  const double inverse_area = 1.0 / static_cast<double>(std::abs(area));
  const std::int64_t bias_a = edgeBias(b, c), bias_b = edgeBias(c, a), bias_c = edgeBias(a, b);
  for (int z = firstLine(std::min({a.z, b.z, c.z})); z <= lastLine(std::max({a.z, b.z, c.z}), grid.size.z()); ++z)
    for (int y = firstLine(std::min({a.y, b.y, c.y})); y <= lastLine(std::max({a.y, b.y, c.y}), grid.size.y()); ++y)
    {
      const std::int64_t wa = edgeFunction(b, c, y * kSubvoxels, z * kSubvoxels);
      const std::int64_t wb = edgeFunction(c, a, y * kSubvoxels, z * kSubvoxels);
      const std::int64_t wc = edgeFunction(a, b, y * kSubvoxels, z * kSubvoxels);
      if (((wa - bias_a) | (wb - bias_b) | (wc - bias_c)) < 0)
        continue;
      const double x = (static_cast<double>(wa) * a.x + static_cast<double>(wb) * b.x + static_cast<double>(wc) * c.x);
      const auto line =
          static_cast<std::size_t>(y) + static_cast<std::size_t>(grid.size.y()) * static_cast<std::size_t>(z);
      crossings.push_back({line, x * inverse_area, sign});
    }
}

/** Marks the voxels of one line between its crossings, which are in order of x. */
void markLine(const Crossing* begin, const Crossing* end, int size, std::uint8_t* line)
{
  int winding = 0;
  for (const Crossing* crossing = begin; crossing != end; ++crossing)
  {
    winding += crossing->sign;
    if (winding <= 0 || crossing + 1 == end)
      continue;
    const double from = std::clamp(std::ceil(crossing->x), 0.0, static_cast<double>(size));
    const double to = std::clamp(std::ceil((crossing + 1)->x), 0.0, static_cast<double>(size));
    for (int x = static_cast<int>(from); x < static_cast<int>(to); ++x)
      line[x] = 1;
  }
}

/** Widens the mask along one axis. */
void dilateAlong(VoxelMask& mask, std::size_t stride, int size, const std::vector<std::size_t>& starts, int voxels)
{
  std::vector<std::uint8_t> line(static_cast<std::size_t>(size));
  for (const std::size_t start : starts)
  {
    int until = -1;
    for (int i = 0; i < size; ++i)
    {
      if (mask[start + static_cast<std::size_t>(i) * stride] != 0)
        until = i + voxels;
      line[static_cast<std::size_t>(i)] = i <= until ? 1 : 0;
    }
    until = size;
    for (int i = size - 1; i >= 0; --i)
    {
      std::uint8_t& voxel = mask[start + static_cast<std::size_t>(i) * stride];
      if (voxel != 0)
        until = i - voxels;
      voxel = i >= until || line[static_cast<std::size_t>(i)] != 0 ? 1 : 0;
    }
  }
}

}  // namespace

VoxelMask lumenMask(const image::VolumeGrid& grid, const geometry::TriangleMesh& mesh)
{
  std::vector<Corner> corners;
  corners.reserve(mesh.vertices.size());
  for (const Eigen::Vector3d& vertex : mesh.vertices)
    corners.push_back(cornerOf(grid, vertex));
  std::vector<Crossing> crossings;
  for (const Eigen::Vector3i& t : mesh.triangles)
    addTriangle(corners[static_cast<std::size_t>(t[0])], corners[static_cast<std::size_t>(t[1])],
                corners[static_cast<std::size_t>(t[2])], grid, crossings);
  const int handedness = grid.axes.determinant() < 0.0 ? -1 : 1;
  for (Crossing& crossing : crossings)
    crossing.sign *= handedness;
  std::sort(crossings.begin(), crossings.end(),
            [](const Crossing& a, const Crossing& b)
            { return a.line != b.line ? a.line < b.line : (a.x != b.x ? a.x < b.x : a.sign > b.sign); });
  VoxelMask mask(grid.voxels(), 0);
  for (std::size_t begin = 0; begin < crossings.size();)
  {
    std::size_t end = begin;
    while (end < crossings.size() && crossings[end].line == crossings[begin].line)
      ++end;
    markLine(crossings.data() + begin, crossings.data() + end, grid.size.x(),
             mask.data() + crossings[begin].line * static_cast<std::size_t>(grid.size.x()));
    begin = end;
  }
  return mask;
}

VoxelMask dilated(const image::VolumeGrid& grid, const VoxelMask& mask, int voxels)
{
  VoxelMask wide = mask;
  const std::array<std::size_t, 3> stride{
      1, static_cast<std::size_t>(grid.size.x()),
      static_cast<std::size_t>(grid.size.x()) * static_cast<std::size_t>(grid.size.y())};
  for (std::size_t axis = 0; axis < 3; ++axis)
  {
    const std::size_t u = (axis + 1) % 3, v = (axis + 2) % 3;
    std::vector<std::size_t> starts;
    for (int i = 0; i < grid.size[static_cast<int>(u)]; ++i)
      for (int j = 0; j < grid.size[static_cast<int>(v)]; ++j)
        starts.push_back(static_cast<std::size_t>(i) * stride[u] + static_cast<std::size_t>(j) * stride[v]);
    dilateAlong(wide, stride[axis], grid.size[static_cast<int>(axis)], starts, voxels);
  }
  return wide;
}

void replaceByBlood(DensityVolume& volume, const VoxelMask& lumen, int rim)
{
  const VoxelMask wide = dilated(volume.grid(), lumen, rim);
  const double of_blood = propertiesOf(Tissue::kBlood).density;
  const std::uint16_t blood = DensityVolume::encode({of_blood, 0.0});
  std::vector<std::uint16_t>& voxels = volume.voxels();
  for (std::size_t i = 0; i < voxels.size(); ++i)
  {
    const Density density = DensityVolume::decode(voxels[i]);
    if (lumen[i] != 0 || (wide[i] != 0 && density.tissue + density.bone > of_blood))
      voxels[i] = blood;
  }
}

}  // namespace endovascular_sim::patient
