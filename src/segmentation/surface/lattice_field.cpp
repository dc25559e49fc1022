#include "segmentation/surface/lattice_field.h"

#include <algorithm>
#include <cmath>
#include <set>
#include <utility>

#include "common/numerics/parallel_for.h"
#include "segmentation/surface/tube.h"

namespace endovascular_sim::segmentation
{
namespace
{

/** Distance outside of a wall up to which values are computed [m]. */
constexpr double kMargin = 1.2e-3;

/** Piece of a tube that a block of points meets. */
struct Candidate
{
  std::size_t tube = 0;
  std::size_t piece = 0;
};

/** Union of samples by a smooth minimum whose range vanishes for equal normals. */
class SmoothUnion
{
public:
  explicit SmoothUnion(double blend) : blend_(blend) {}

  void add(const Tube::Sample& sample)
  {
    if (sample.distance >= 1e30)
      return;
    if (empty_)
    {
      value_ = sample;
      empty_ = false;
      return;
    }
    const double turn = 0.5 * (1.0 - value_.outward.dot(sample.outward));
    const double range = turn * blend_ * std::min(value_.radius, sample.radius);
    const double h = range > 0.0 ? std::max(range - std::abs(value_.distance - sample.distance), 0.0) / range : 0.0;
    const double fill = h * h * h * range / 6.0;
    if (sample.distance < value_.distance)
      value_ = sample;
    value_.distance -= fill;
  }

  double value() const { return empty_ ? LatticeField::kOutside : value_.distance; }

private:
  double blend_;
  bool empty_ = true;
  Tube::Sample value_;
};

}  // namespace

LatticeField::LatticeField(const std::vector<LumenBranch>& branches, double spacing, double blend, int threads)
  : spacing_(spacing)
{
  std::vector<Tube> tubes;
  for (const LumenBranch& branch : branches)
    tubes.emplace_back(branch.sections, kMargin);
  const double edge = kEdge * spacing;
  const double half = 0.5 * std::sqrt(3.0) * edge;
  std::map<Key, std::vector<Candidate>> candidates;
  for (std::size_t t = 0; t < tubes.size(); ++t)
    for (std::size_t s = 0; s < tubes[t].pieces().size(); ++s)
    {
      const Tube::Piece& piece = tubes[t].pieces()[s];
      const Eigen::Vector3i low = ((piece.centre.array() - piece.reach) / edge).floor().cast<int>();
      const Eigen::Vector3i high = ((piece.centre.array() + piece.reach) / edge).floor().cast<int>();
      for (int z = low.z(); z <= high.z(); ++z)
        for (int y = low.y(); y <= high.y(); ++y)
          for (int x = low.x(); x <= high.x(); ++x)
          {
            const Eigen::Vector3d centre = edge * (Eigen::Vector3d(x, y, z) + Eigen::Vector3d::Constant(0.5));
            if ((centre - piece.centre).norm() < piece.reach + half && tubes[t].isNear(piece, centre, half))
              candidates[{x, y, z}].push_back({t, s});
          }
    }
  std::vector<std::pair<const Key, std::vector<Candidate>>*> work;
  for (auto& entry : candidates)
  {
    work.push_back(&entry);
    blocks_[entry.first];
  }
  parallelFor(work.size(), threads,
              [&](std::size_t n)
              {
                const Key& key = work[n]->first;
                Values& values = blocks_.find(key)->second;
                std::size_t at = 0;
                for (int c = 0; c < kEdge; ++c)
                  for (int b = 0; b < kEdge; ++b)
                    for (int a = 0; a < kEdge; ++a)
                    {
                      const Eigen::Vector3d p =
                          spacing * Eigen::Vector3d(key[0] * kEdge + a, key[1] * kEdge + b, key[2] * kEdge + c);
                      SmoothUnion united(blend);
                      Tube::Sample sample;
                      std::size_t tube = work[n]->second.front().tube;
                      for (const Candidate& candidate : work[n]->second)
                      {
                        if (candidate.tube != tube)
                        {
                          united.add(sample);
                          sample = {};
                          tube = candidate.tube;
                        }
                        tubes[tube].sample(tubes[tube].pieces()[candidate.piece], p, sample);
                      }
                      united.add(sample);
                      values[at++] = static_cast<float>(united.value());
                    }
              });
}

LatticeField::LatticeField(const std::vector<float>& values, const Eigen::Vector3i& size) : spacing_(1.0)
{
  const auto valueAt = [&](const Eigen::Vector3i& p)
  {
    if ((p.array() < 0).any() || (p.array() >= size.array()).any())
      return kOutside;
    return values[(static_cast<std::size_t>(p.z()) * static_cast<std::size_t>(size.y()) +
                   static_cast<std::size_t>(p.y())) *
                      static_cast<std::size_t>(size.x()) +
                  static_cast<std::size_t>(p.x())];
  };
  // Blocks with a negative value, and those before and behind, whose cubes reach it.
  std::set<Key> keys;
  for (int k = 0; k < size.z(); ++k)
    for (int j = 0; j < size.y(); ++j)
      for (int i = 0; i < size.x(); ++i)
        if (valueAt({i, j, k}) < 0.0F)
          for (int corner = 0; corner < 8; ++corner)
            keys.insert({(i + ((corner & 1) != 0 ? 1 : -1)) / kEdge, (j + ((corner & 2) != 0 ? 1 : -1)) / kEdge,
                         (k + ((corner & 4) != 0 ? 1 : -1)) / kEdge});
  for (const Key& key : keys)
  {
    Values& block = blocks_[key];
    std::size_t at = 0;
    for (int c = 0; c < kEdge; ++c)
      for (int b = 0; b < kEdge; ++b)
        for (int a = 0; a < kEdge; ++a)
          block[at++] = valueAt({key[0] * kEdge + a, key[1] * kEdge + b, key[2] * kEdge + c});
  }
}

}  // namespace endovascular_sim::segmentation
