#include "segmentation/lumen/minimal_path.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <memory>
#include <queue>

namespace endovascular_sim::segmentation
{
namespace
{

constexpr float kSlowest = 0.004F;
constexpr float kSlowInWideRegions = 0.006F;
/** Share of the contrast below which a point of a path counts as outside of the lumen. */
constexpr double kOutside = 0.35;
constexpr int kEdge = 16;  ///< voxels along the edge of a block

struct Block
{
  std::array<float, kEdge * kEdge * kEdge> time;
  std::array<float, kEdge * kEdge * kEdge> slowness;    ///< 0: not computed
  std::array<std::int8_t, kEdge * kEdge * kEdge> from;  ///< neighbour from which the path comes; −1: none
};

/** Search over the voxels of an image, with memory by blocks. */
class Search
{
public:
  Search(const Scan& scan, const LumenRange& range, const WideRegions& wide, double least)
    : scan_(scan), range_(range), wide_(wide), least_(least), blocks_((scan.size().array() + kEdge - 1) / kEdge)
  {
    table_.resize(static_cast<std::size_t>(blocks_.x()) * static_cast<std::size_t>(blocks_.y()) *
                  static_cast<std::size_t>(blocks_.z()));
    for (int n = 0; n < 27; ++n)
    {
      steps_[n] = Eigen::Vector3i(n % 3, n / 3 % 3, n / 9) - Eigen::Vector3i::Ones();
      // Sorted squares: equal steps along different axes have equal bits.
      std::array<double, 3> squares;
      for (int axis = 0; axis < 3; ++axis)
        squares[static_cast<std::size_t>(axis)] = std::pow(steps_[n][axis] * scan.spacing()[axis], 2);
      std::sort(squares.begin(), squares.end());
      lengths_[n] = static_cast<float>(1e3 * std::sqrt(squares[0] + squares[1] + squares[2]));
    }
  }

  std::vector<Eigen::Vector3i> run(const Eigen::Vector3i& begin, const Eigen::Vector3i& end)
  {
    struct Entry
    {
      float bound;
      float time;
      std::array<std::int16_t, 3> voxel;
      bool operator>(const Entry& other) const
      {
        return bound != other.bound ? bound > other.bound : voxel > other.voxel;
      }
    };
    std::priority_queue<Entry, std::vector<Entry>, std::greater<>> queue;
    const auto push = [&](const Eigen::Vector3i& v, float time)
    {
      const Eigen::Vector3d apart = (v - end).cast<double>().cwiseProduct(scan_.spacing());
      queue.push(
          {time + static_cast<float>(1e3 * apart.norm()),
           time,
           {static_cast<std::int16_t>(v.x()), static_cast<std::int16_t>(v.y()), static_cast<std::int16_t>(v.z())}});
    };
    Block& first = blockOf(begin);
    first.time[placeOf(begin)] = 0.0F;
    push(begin, 0.0F);
    while (!queue.empty())
    {
      const Entry entry = queue.top();
      queue.pop();
      const Eigen::Vector3i v(entry.voxel[0], entry.voxel[1], entry.voxel[2]);
      if (entry.time > blockOf(v).time[placeOf(v)])
        continue;
      if (v == end)
        break;
      const float own = slownessOf(v);
      for (int n = 0; n < 27; ++n)
      {
        if (n == 13)
          continue;
        const Eigen::Vector3i w = v + steps_[n];
        if ((w.array() < 0).any() || (w.array() >= scan_.size().array()).any())
          continue;
        if (w != end && scan_.value(w.x(), w.y(), w.z()) < least_)
          continue;
        const float time = entry.time + 0.5F * lengths_[n] * (own + slownessOf(w));
        Block& block = blockOf(w);
        const std::size_t place = placeOf(w);
        if (time < block.time[place])
        {
          block.time[place] = time;
          block.from[place] = static_cast<std::int8_t>(n);
          push(w, time);
        }
      }
    }
    if (begin != end && blockOf(end).from[placeOf(end)] < 0)
      return {};
    std::vector<Eigen::Vector3i> path{end};
    while (path.back() != begin)
    {
      const Eigen::Vector3i v = path.back();
      path.push_back(v - steps_[blockOf(v).from[placeOf(v)]]);
    }
    std::reverse(path.begin(), path.end());
    return path;
  }

private:
  static std::size_t placeOf(const Eigen::Vector3i& v)
  {
    return static_cast<std::size_t>((v.z() % kEdge * kEdge + v.y() % kEdge) * kEdge + v.x() % kEdge);
  }

  Block& blockOf(const Eigen::Vector3i& v)
  {
    const Eigen::Vector3i b = v / kEdge;
    std::unique_ptr<Block>& block = table_[(static_cast<std::size_t>(b.z()) * static_cast<std::size_t>(blocks_.y()) +
                                            static_cast<std::size_t>(b.y())) *
                                               static_cast<std::size_t>(blocks_.x()) +
                                           static_cast<std::size_t>(b.x())];
    if (!block)
    {
      block = std::make_unique<Block>();
      block->time.fill(1e30F);
      block->slowness.fill(0.0F);
      block->from.fill(-1);
    }
    return *block;
  }

  float slownessOf(const Eigen::Vector3i& v)
  {
    float& slowness = blockOf(v).slowness[placeOf(v)];
    if (slowness == 0.0F)
    {
      const double value = scan_.value(v.x(), v.y(), v.z());
      double z = 0.0;
      if (value < range_.low)
        z = (value - range_.low) / range_.width();
      else if (value > range_.high && scan_.modality() == image::Modality::kCt)  // calcium; MR has none
        z = 0.5 * (value - range_.high) / range_.width();
      float speed = std::max(static_cast<float>(std::exp(-0.5 * z * z)), kSlowest);
      if (speed > kSlowInWideRegions && wide_.contains(scan_.centreOf(v)))
        speed = kSlowInWideRegions;
      slowness = 1.0F / speed;
    }
    return slowness;
  }

  const Scan& scan_;
  const LumenRange& range_;
  const WideRegions& wide_;
  double least_;
  Eigen::Vector3i blocks_;
  std::vector<std::unique_ptr<Block>> table_;
  std::array<Eigen::Vector3i, 27> steps_;
  std::array<float, 27> lengths_{};  ///< [mm]
};

/** Finds the longest stretch of a path outside of the lumen, by means of three successive values. */
void findGap(const Scan& scan, const LumenRange& range, MinimalPath& path)
{
  const double outside = range.background + kOutside * (range.low - range.background);
  std::vector<double> values;
  values.reserve(path.points.size());
  for (const Eigen::Vector3d& p : path.points)
    values.push_back(scan.at(p));
  std::size_t begin = 1;
  for (std::size_t k = 1; k + 1 < path.points.size(); ++k)
  {
    if ((values[k - 1] + values[k] + values[k + 1]) / 3.0 >= outside)
      begin = k + 1;
    else if (const double length = (path.points[k] - path.points[begin]).norm(); length > path.longest_gap)
    {
      path.longest_gap = length;
      path.gap_location = 0.5 * (path.points[k] + path.points[begin]);
    }
  }
}

}  // namespace

MinimalPath minimalPath(const Scan& scan, const Eigen::Vector3d& from, const Eigen::Vector3d& to,
                        const LumenRange& range, const WideRegions& wide, double least)
{
  MinimalPath path;
  for (const Eigen::Vector3i& voxel : Search(scan, range, wide, least).run(scan.voxelOf(from), scan.voxelOf(to)))
    path.points.push_back(scan.centreOf(voxel));
  if (path.points.empty())
    return path;
  if (path.points.size() < 2)
    path.points.push_back(to);
  path.points.front() = from;
  path.points.back() = to;
  findGap(scan, range, path);
  return path;
}

}  // namespace endovascular_sim::segmentation
