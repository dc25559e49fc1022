#pragma once

#include <algorithm>
#include <cstdint>
#include <vector>

namespace endovascular_sim::geometry
{

/** Hash map from an edge (unordered pair of vertices) to a vertex, with open addressing. It offers no iteration, so
 *  results cannot depend on the order of its slots. */
class EdgeTable
{
public:
  EdgeTable() : slots_(1U << 16U) {}

  /** Vertex stored for the edge; −1 without an entry. */
  int find(int a, int b) const
  {
    const std::uint64_t key = keyOf(a, b);
    for (std::size_t i = start(key);; i = (i + 1) & (slots_.size() - 1))
    {
      if (slots_[i].key == key)
        return slots_[i].vertex;
      if (slots_[i].key == 0)
        return -1;
    }
  }

  /** Stores a vertex for an edge.
   *  @pre the edge has no entry */
  void insert(int a, int b, int vertex)
  {
    if (2 * ++count_ > slots_.size())
      grow();
    store({keyOf(a, b), vertex});
  }

private:
  struct Slot
  {
    std::uint64_t key = 0;
    int vertex = -1;
  };

  static std::uint64_t keyOf(int a, int b)
  {
    return (static_cast<std::uint64_t>(std::min(a, b)) << 32U) + static_cast<std::uint64_t>(std::max(a, b)) + 1U;
  }

  std::size_t start(std::uint64_t key) const
  {
    key = (key ^ (key >> 31U)) * 0x9e3779b97f4a7c15ULL;
    return static_cast<std::size_t>(key >> 20U) & (slots_.size() - 1);
  }

  void store(const Slot& slot)
  {
    std::size_t i = start(slot.key);
    while (slots_[i].key != 0)
      i = (i + 1) & (slots_.size() - 1);
    slots_[i] = slot;
  }

  void grow()
  {
    std::vector<Slot> old(2 * slots_.size());
    old.swap(slots_);
    for (const Slot& slot : old)
      if (slot.key != 0)
        store(slot);
  }

  std::vector<Slot> slots_;
  std::size_t count_ = 0;
};

}  // namespace endovascular_sim::geometry
