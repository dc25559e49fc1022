#include "segmentation/labels/mask_topology.h"

#include <bitset>
#include <cstdint>
#include <queue>
#include <utility>

namespace endovascular_sim::segmentation
{
namespace
{

constexpr unsigned kAll = (1U << kNeighbours) - 1U;

/** Neighbours of every neighbour within the link of a voxel, as bits. */
std::array<unsigned, kNeighbours> linkOf()
{
  std::array<unsigned, kNeighbours> link{};
  const auto& steps = neighbourSteps();
  for (std::size_t a = 0; a < kNeighbours; ++a)
    for (std::size_t b = 0; b < kNeighbours; ++b)
      for (const Eigen::Vector3i& step : steps)
        if (steps[b] - steps[a] == step)
          link[a] |= 1U << b;
  return link;
}

/** True for a set of neighbours that is not empty and connected within the link. */
bool isConnected(unsigned set, const std::array<unsigned, kNeighbours>& link)
{
  if (set == 0U)
    return false;
  unsigned reached = set & (~set + 1U);
  for (unsigned before = 0U; before != reached;)
  {
    before = reached;
    for (std::size_t n = 0; n < kNeighbours; ++n)
      if ((reached >> n & 1U) != 0U)
        reached |= link[n] & set;
  }
  return reached == set;
}

/** Table of the neighbourhoods in which a voxel is simple. */
const std::bitset<kAll + 1>& simplePoints()
{
  static const std::bitset<kAll + 1> table = []
  {
    std::bitset<kAll + 1> simple;
    const std::array<unsigned, kNeighbours> link = linkOf();
    for (unsigned set = 0; set <= kAll; ++set)
      simple[set] = isConnected(set, link) && isConnected(~set & kAll, link);
    return simple;
  }();
  return table;
}

/** Calls a function with every neighbour of a voxel, its number and its place in memory. */
template <typename Function>
void forNeighbours(const VoxelMask& mask, std::size_t at, const Function& function)
{
  const Eigen::Vector3i voxel = mask.voxelOf(at);
  const auto& steps = neighbourSteps();
  for (std::size_t n = 0; n < kNeighbours; ++n)
  {
    const Eigen::Vector3i next = voxel + steps[n];
    if (mask.holds(next))
      function(n, mask.offset(next));
  }
}

}  // namespace

const std::array<Eigen::Vector3i, kNeighbours>& neighbourSteps()
{
  static const std::array<Eigen::Vector3i, kNeighbours> steps = []
  {
    std::array<Eigen::Vector3i, kNeighbours> list;
    std::size_t n = 0;
    for (int bits = 1; bits < 8; ++bits)
    {
      const Eigen::Vector3i step(bits & 1, bits >> 1 & 1, bits >> 2);
      list[n++] = step;
      list[n++] = -step;
    }
    return list;
  }();
  return steps;
}

std::vector<std::size_t> componentsOf(const VoxelMask& mask, std::uint8_t value, std::vector<int>& component)
{
  component.assign(mask.inside.size(), -1);
  std::vector<std::size_t> sizes;
  std::vector<std::size_t> open;
  for (std::size_t begin = 0; begin < mask.inside.size(); ++begin)
  {
    if (mask.inside[begin] != value || component[begin] >= 0)
      continue;
    const int name = static_cast<int>(sizes.size());
    sizes.push_back(0);
    component[begin] = name;
    open.push_back(begin);
    while (!open.empty())
    {
      const std::size_t at = open.back();
      open.pop_back();
      ++sizes.back();
      forNeighbours(mask, at,
                    [&](std::size_t, std::size_t next)
                    {
                      if (mask.inside[next] != value || component[next] >= 0)
                        return;
                      component[next] = name;
                      open.push_back(next);
                    });
    }
  }
  return sizes;
}

long handlesOf(const VoxelMask& mask)
{
  // Every simplex of the triangulation is a chain of increasing corners of one cube, counted at its lowest voxel.
  long euler = 0;
  const Eigen::Vector3i last = mask.size - Eigen::Vector3i::Ones();
  for (int k = 0; k < last.z(); ++k)
    for (int j = 0; j < last.y(); ++j)
      for (int i = 0; i < last.x(); ++i)
      {
        if (!mask.at({i, j, k}))
          continue;
        std::array<bool, 8> corner{};
        for (int bits = 1; bits < 8; ++bits)
          corner[static_cast<std::size_t>(bits)] = mask.at({i + (bits & 1), j + (bits >> 1 & 1), k + (bits >> 2)});
        // Number of chains from the lowest voxel, with the sign of their dimension, by recursion over their last
        // corner.
        std::array<long, 8> chains{};
        chains[0] = 1;
        euler += 1;
        for (unsigned to = 1; to < 8; ++to)
        {
          if (!corner[to])
            continue;
          for (unsigned from = 0; from < to; ++from)
            if ((from & to) == from)
              chains[to] -= chains[from];
          euler += chains[to];
        }
      }
  std::vector<int> component;
  const auto pieces = static_cast<long>(componentsOf(mask, 1, component).size());
  const auto cavities = static_cast<long>(componentsOf(mask, 0, component).size()) - 1;
  return pieces + cavities - euler;
}

VoxelMask grown(const VoxelMask& mask, const std::vector<std::size_t>& seeds, const std::vector<float>& depth)
{
  VoxelMask result(mask.size, mask.spacing, mask.first);
  std::vector<std::uint8_t> queued(mask.inside.size(), 0);
  // Deepest first; of equal ones, the first in memory.
  const auto later = [&depth](std::size_t a, std::size_t b)
  { return depth[a] < depth[b] || (depth[a] == depth[b] && a > b); };
  std::priority_queue<std::size_t, std::vector<std::size_t>, decltype(later)> open(later);
  const auto add = [&](std::size_t at)
  {
    result.inside[at] = 1;
    forNeighbours(mask, at,
                  [&](std::size_t, std::size_t next)
                  {
                    if (mask.inside[next] == 0 || result.inside[next] != 0 || queued[next] != 0)
                      return;
                    queued[next] = 1;
                    open.push(next);
                  });
  };
  for (const std::size_t seed : seeds)
    result.inside[seed] = 1;
  for (const std::size_t seed : seeds)
    add(seed);
  while (!open.empty())
  {
    const std::size_t at = open.top();
    open.pop();
    queued[at] = 0;
    unsigned set = 0;
    forNeighbours(mask, at,
                  [&](std::size_t n, std::size_t next) { set |= static_cast<unsigned>(result.inside[next]) << n; });
    if (simplePoints()[set])
      add(at);
  }
  return result;
}

}  // namespace endovascular_sim::segmentation
