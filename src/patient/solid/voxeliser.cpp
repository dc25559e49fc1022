#include "patient/solid/voxeliser.h"

#include <algorithm>
#include <cmath>

#include "patient/solid/texture.h"

namespace endovascular_sim::patient
{
namespace
{

constexpr int kSlab = 8;        // layers per slab
constexpr float kEdge = 1.75F;  // width of an edge in voxels; narrower edges alias into stripes where rays graze them
constexpr float kFar = 1e6F;    // distance outside of all boxes [mm]

/** Voxels [begin, end) along each axis. */
struct Range
{
  Eigen::Vector3i begin, end;
};

/** Some layers of the volume, in the body's frame. */
class Slab
{
public:
  Slab(const DensityVolume& volume, const BodyFrame& frame, int first, int last, std::uint64_t seed)
    : size_(volume.grid().size.x(), volume.grid().size.y(), last - first),
      first_(frame.fromPatient(volume.grid().position(Eigen::Vector3d(0.0, 0.0, first)))),
      step_((volume.grid().spacing / (1e-3 * frame.scale)).cast<float>()),
      seed_(seed)
  {
    const auto voxels = static_cast<std::size_t>(size_.prod());
    tissue_.assign(voxels, 0.0F);
    bone_.assign(voxels, 0.0F);
    distance_.assign(voxels, kFar);
  }

  void draw(const BodyPart& part)
  {
    Box box;
    for (const SolidPointer& solid : part.solids)
      box.extend(solid->box());
    const float margin = 2.0F * step_.maxCoeff() + part.material.edge;
    const Range range = rangeOf(box, margin);
    if ((range.end - range.begin).minCoeff() <= 0)
      return;
    forEach(range, [&](std::size_t at, const Point&) { distance_[at] = kFar; });
    for (const SolidPointer& solid : part.solids)
      forEach(rangeOf(solid->box(), margin),
              [&](std::size_t at, const Point& p) { distance_[at] = std::min(distance_[at], solid->distance(p)); });
    for (const SolidPointer& hole : part.holes)
      forEach(intersection(range, rangeOf(hole->box(), margin)),
              [&](std::size_t at, const Point& p) { distance_[at] = std::max(distance_[at], -hole->distance(p)); });
    forEach(range, [&](std::size_t at, const Point& p) { apply(part.material, at, p); });
  }

  /** Stores the slab; bone displaces soft tissue. */
  void store(DensityVolume& volume, int first)
  {
    const std::size_t begin = volume.grid().offset(0, 0, first);
    forEach(
        {Eigen::Vector3i::Zero(), size_},
        [&](std::size_t at, const Point& p)
        {
          if (tissue_[at] == 0.0F && bone_[at] == 0.0F)
            return;
          const float left = std::max(0.0F, 1.0F - bone_[at] / kCorticalBone);
          volume.voxels()[begin + at] = DensityVolume::encode({tissue_[at] * left * softTexture(p, seed_), bone_[at]});
        });
  }

private:
  static Range intersection(const Range& a, const Range& b)
  {
    return {a.begin.cwiseMax(b.begin), a.end.cwiseMin(b.end)};
  }

  Range rangeOf(const Box& box, float margin) const
  {
    const Point low = ((box.min().array() - margin - first_.array()) / step_.array()).matrix();
    const Point high = ((box.max().array() + margin - first_.array()) / step_.array()).matrix();
    Range range;
    for (int axis = 0; axis < 3; ++axis)
    {
      const auto limit = static_cast<float>(size_[axis]);
      range.begin[axis] = static_cast<int>(std::clamp(std::ceil(low[axis]), 0.0F, limit));
      range.end[axis] = static_cast<int>(std::clamp(std::floor(high[axis]) + 1.0F, 0.0F, limit));
    }
    return range;
  }

  template <typename Visit>
  void forEach(const Range& range, Visit visit) const
  {
    for (int z = range.begin.z(); z < range.end.z(); ++z)
      for (int y = range.begin.y(); y < range.end.y(); ++y)
      {
        std::size_t at = static_cast<std::size_t>((z * size_.y() + y) * size_.x() + range.begin.x());
        for (int x = range.begin.x(); x < range.end.x(); ++x, ++at)
          visit(at, Point(first_ + step_.cwiseProduct(Eigen::Vector3i(x, y, z).cast<float>())));
      }
  }

  void apply(const Material& material, std::size_t at, const Point& p)
  {
    const float width = kEdge * step_.x() + material.edge;
    const float share = std::clamp(0.5F - distance_[at] / width, 0.0F, 1.0F);
    if (share == 0.0F)
      return;
    const float mixed = tissue_[at] + share * (material.density - tissue_[at]);
    if (material.kind == Material::Kind::kReplace)
      tissue_[at] = mixed;
    else if (material.kind == Material::Kind::kDenser)
      tissue_[at] = std::max(tissue_[at], mixed);
    else
    {
      const float muscle = propertiesOf(Tissue::kMuscle).density;
      bone_[at] = std::max(bone_[at], share * boneDensity(material, distance_[at], p));
      tissue_[at] = std::max(tissue_[at], tissue_[at] + share * (muscle - tissue_[at]));  // marrow, also within lung
    }
  }

  float boneDensity(const Material& material, float distance, const Point& p) const
  {
    const float core = std::clamp(0.5F - (distance + material.cortex) / step_.x(), 0.0F, 1.0F);
    if (core == 0.0F)
      return material.density;
    return material.density + core * (material.core * trabecularTexture(p, seed_ + 7) - material.density);
  }

  Eigen::Vector3i size_;
  Point first_;
  Point step_;
  std::uint64_t seed_;
  std::vector<float> tissue_;
  std::vector<float> bone_;
  std::vector<float> distance_;
};

}  // namespace

void voxelise(const BodyPlan& plan, const BodyFrame& frame, std::uint64_t seed, DensityVolume& volume)
{
  const int layers = volume.grid().size.z();
  for (int first = 0; first < layers; first += kSlab)
  {
    Slab slab(volume, frame, first, std::min(first + kSlab, layers), seed);
    for (const BodyPart& part : plan)
      slab.draw(part);
    slab.store(volume, first);
  }
}

}  // namespace endovascular_sim::patient
