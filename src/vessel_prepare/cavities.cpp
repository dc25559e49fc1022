#include "vessel_prepare/cavities.h"

#include <openvdb/tools/SignedFloodFill.h>

#include <array>
#include <cmath>
#include <cstdint>
#include <vector>

namespace endovascular_sim::vessel
{
namespace
{

/** Two neighbouring voxels with a triangle between them are not both farther from it than this, in voxels. */
constexpr float kBlocking = 0.5F;

/** The box round a grid, a state for each of its voxels. */
class Flood
{
public:
  enum : std::uint8_t
  {
    kFree,     ///< positive, away from walls, not reached
    kFar,      ///< the same, beyond the band
    kBlocked,  ///< inside, or next to a wall
    kOutside,
    kHollow,
  };

  explicit Flood(const openvdb::FloatGrid& grid)
  {
    openvdb::CoordBBox box = grid.evalActiveVoxelBoundingBox();
    box.expand(2);
    low_ = box.min();
    size_ = box.dim();
    state_.resize(static_cast<std::size_t>(size_.x()) * static_cast<std::size_t>(size_.y()) *
                  static_cast<std::size_t>(size_.z()));
    auto accessor = grid.getConstAccessor();
    std::size_t k = 0;
    for (int x = 0; x < size_.x(); ++x)
      for (int y = 0; y < size_.y(); ++y)
        for (int z = 0; z < size_.z(); ++z)
        {
          float distance = 0.0F;
          const bool active = accessor.probeValue(low_.offsetBy(x, y, z), distance);
          state_[k++] = distance <= kBlocking ? kBlocked : (active ? kFree : kFar);
        }
  }

  /** Reaches everything from the box's corner. */
  void fromOutside() { fill(0, kOutside); }

  /** Reaches everything from what is left beyond the band. @return whether there was any */
  bool intoHollows()
  {
    bool any = false;
    for (std::size_t k = 0; k < state_.size(); ++k)
      if (state_[k] == kFar)
      {
        fill(k, kHollow);
        any = true;
      }
    return any;
  }

  std::uint8_t at(const openvdb::Coord& p) const { return state_[index(p - low_)]; }

private:
  std::size_t index(const openvdb::Coord& p) const
  {
    return (static_cast<std::size_t>(p.x()) * static_cast<std::size_t>(size_.y()) + static_cast<std::size_t>(p.y())) *
               static_cast<std::size_t>(size_.z()) +
           static_cast<std::size_t>(p.z());
  }

  void fill(std::size_t seed, std::uint8_t mark)
  {
    const auto depth = static_cast<std::size_t>(size_.z());
    const std::size_t sheet = depth * static_cast<std::size_t>(size_.y());
    std::vector<std::size_t> open{seed};
    state_[seed] = mark;
    const auto visit = [&](std::size_t k)
    {
      if (state_[k] > kFar)
        return;
      state_[k] = mark;
      open.push_back(k);
    };
    while (!open.empty())
    {
      const std::size_t k = open.back();
      open.pop_back();
      const std::size_t z = k % depth;
      const std::size_t in_sheet = k % sheet;
      if (z > 0)
        visit(k - 1);
      if (z + 1 < depth)
        visit(k + 1);
      if (in_sheet >= depth)
        visit(k - depth);
      if (in_sheet + depth < sheet)
        visit(k + depth);
      if (k >= sheet)
        visit(k - sheet);
      if (k + sheet < state_.size())
        visit(k + sheet);
    }
  }

  openvdb::Coord low_;
  openvdb::Coord size_;
  std::vector<std::uint8_t> state_;
};

/** Next to a wall the side is that of the neighbours. */
bool besideHollowOnly(const Flood& flood, const openvdb::Coord& p)
{
  static const std::array<openvdb::Coord, 6> kSteps{openvdb::Coord(1, 0, 0), openvdb::Coord(-1, 0, 0),
                                                    openvdb::Coord(0, 1, 0), openvdb::Coord(0, -1, 0),
                                                    openvdb::Coord(0, 0, 1), openvdb::Coord(0, 0, -1)};
  bool hollow = false;
  for (const openvdb::Coord& step : kSteps)
  {
    const std::uint8_t state = flood.at(p + step);
    if (state == Flood::kOutside)
      return false;
    hollow = hollow || state == Flood::kHollow;
  }
  return hollow;
}

}  // namespace

void fillCavities(openvdb::FloatGrid& grid)
{
  Flood flood(grid);
  flood.fromOutside();
  if (!flood.intoHollows())
    return;
  for (auto voxel = grid.beginValueOn(); voxel; ++voxel)
  {
    if (*voxel < 0.0F || !voxel.isVoxelValue())
      continue;
    const openvdb::Coord p = voxel.getCoord();
    if (flood.at(p) == Flood::kHollow || (flood.at(p) == Flood::kBlocked && besideHollowOnly(flood, p)))
      voxel.setValue(-*voxel);
  }
  openvdb::tools::signedFloodFill(grid.tree());
}

}  // namespace endovascular_sim::vessel
