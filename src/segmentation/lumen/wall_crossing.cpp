#include "segmentation/lumen/wall_crossing.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <utility>

#include "segmentation/lumen/local_lumen.h"

namespace endovascular_sim::segmentation
{
namespace
{

constexpr double kDip = 0.2;          ///< least depth of a dark place, in contrasts
constexpr double kCalcium = 2.0;      ///< value above the lumen from which a voxel is calcium or bone, in widths
constexpr double kOwnLumen = 1.5;     ///< radius of the ball within which the own lumen is connected, in lumen radii
constexpr double kArmReach = 4.0;     ///< radius of the sphere on which arms of a lumen are counted, in lumen radii
constexpr double kLeastArm = 0.3;     ///< least area of an arm on the sphere, in areas of the lumen
constexpr double kWideArm = 4.0;      ///< area that counts as two arms: a chamber
constexpr std::size_t kInwards = 4;   ///< points beside a dark place at which the radius is measured
constexpr std::size_t kSmoothed = 2;  ///< points on both sides in the mean that counts as a bright side

/** Values that voxels of a lumen have. */
struct Values
{
  double least = 0.0;
  double most = 0.0;
};

/** Voxels of a lumen that are connected with a voxel, by layers. */
class Flood
{
public:
  Flood(const Scan& scan, const Eigen::Vector3i& begin, const Values& values)
    : scan_(scan), values_(values), reached_(scan.volume().stored.size(), false), front_{begin}
  {
    reached_[placeOf(begin)] = true;
  }

  bool contains(const Eigen::Vector3i& voxel) const { return reached_[placeOf(voxel)]; }
  std::size_t width() const { return front_.size(); }
  const std::vector<Eigen::Vector3i>& front() const { return front_; }

  /** Adds the neighbours of the newest voxels that a condition admits.
   *  @param isMet stops the growth; called with every new voxel
   *  @return true if it was stopped */
  template <typename Condition, typename Stop>
  bool grow(const Condition& isAdmitted, const Stop& isMet)
  {
    std::vector<Eigen::Vector3i> next;
    for (const Eigen::Vector3i& voxel : front_)
      for (int n = 0; n < 27; ++n)
      {
        const Eigen::Vector3i w = voxel + Eigen::Vector3i(n % 3, n / 3 % 3, n / 9) - Eigen::Vector3i::Ones();
        if ((w.array() < 0).any() || (w.array() >= scan_.size().array()).any() || reached_[placeOf(w)])
          continue;
        const double value = scan_.value(w.x(), w.y(), w.z());
        const bool is_met = isMet(w);  // the goal itself may be beside the lumen: the place of a click
        if (!is_met && (value < values_.least || value > values_.most || !isAdmitted(w)))
          continue;
        if (is_met)
          return true;
        reached_[placeOf(w)] = true;
        next.push_back(w);
      }
    front_ = std::move(next);
    return false;
  }

private:
  std::size_t placeOf(const Eigen::Vector3i& v) const { return scan_.volume().grid.offset(v.x(), v.y(), v.z()); }

  const Scan& scan_;
  Values values_;
  std::vector<bool> reached_;
  std::vector<Eigen::Vector3i> front_;
};

/** True if two voxels are connected within a ball. */
bool isConnectedWithin(const Scan& scan, const Eigen::Vector3i& a, const Eigen::Vector3i& b, const Values& values,
                       const Eigen::Vector3d& centre, double radius)
{
  Flood flood(scan, a, values);
  while (flood.width() > 0)
    if (flood.grow([&](const Eigen::Vector3i& w) { return (scan.centreOf(w) - centre).norm() < radius; },
                   [&b](const Eigen::Vector3i& w) { return w == b; }))
      return true;
  return false;
}

/** Number of arms by which a lumen leaves a ball: its connected parts in the outermost layer of the ball.
 *  @param lumen_radius [m] */
int armsOf(const Scan& scan, const Eigen::Vector3i& begin, const Values& values, const Eigen::Vector3d& centre,
           double lumen_radius)
{
  const double radius = kArmReach * lumen_radius;
  const double layer = 2.0 * scan.spacing().maxCoeff();
  const auto isInLayer = [&](const Eigen::Vector3i& v)
  {
    const double d = (scan.centreOf(v) - centre).norm();
    return d < radius && d >= radius - layer;
  };
  const auto never = [](const Eigen::Vector3i&) { return false; };
  std::vector<Eigen::Vector3i> outermost;
  Flood lumen(scan, begin, values);
  while (lumen.width() > 0)
  {
    std::copy_if(lumen.front().begin(), lumen.front().end(), std::back_inserter(outermost), isInLayer);
    lumen.grow([&](const Eigen::Vector3i& v) { return (scan.centreOf(v) - centre).norm() < radius; }, never);
  }
  const double lumen_volume = M_PI * lumen_radius * lumen_radius * layer;
  std::vector<bool> counted(scan.volume().stored.size(), false);
  const auto placeOf = [&scan](const Eigen::Vector3i& v) { return scan.volume().grid.offset(v.x(), v.y(), v.z()); };
  int arms = 0;
  for (const Eigen::Vector3i& voxel : outermost)
  {
    if (counted[placeOf(voxel)])
      continue;
    std::size_t voxels = 0;
    Flood arm(scan, voxel, values);
    while (arm.width() > 0)
    {
      voxels += arm.width();
      for (const Eigen::Vector3i& v : arm.front())
        counted[placeOf(v)] = true;
      arm.grow([&](const Eigen::Vector3i& v) { return isInLayer(v) && lumen.contains(v); }, never);
    }
    const double share = static_cast<double>(voxels) * scan.spacing().prod() / lumen_volume;
    arms += share > kWideArm ? 2 : share > kLeastArm ? 1 : 0;
  }
  return arms;
}

/** True if two voxels are connected anywhere in the image. Grows from both; ends with the smaller of two lumens. */
bool isConnected(const Scan& scan, const Eigen::Vector3i& a, const Eigen::Vector3i& b, const Values& values)
{
  Flood from_a(scan, a, values);
  Flood from_b(scan, b, values);
  while (from_a.width() > 0 && from_b.width() > 0)
  {
    Flood& smaller = from_a.width() <= from_b.width() ? from_a : from_b;
    const Flood& other = &smaller == &from_a ? from_b : from_a;
    if (smaller.grow([](const Eigen::Vector3i&) { return true; },
                     [&other](const Eigen::Vector3i& w) { return other.contains(w); }))
      return true;
  }
  return false;
}

/** Values along a path, and how bright the brightest places before and behind each point are. */
struct Profile
{
  std::vector<double> values;
  std::vector<double> sides;  ///< the darker one of the two brightest places

  Profile(const Scan& scan, const std::vector<Eigen::Vector3d>& path, double lumen)
  {
    const std::size_t n = path.size();
    for (const Eigen::Vector3d& p : path)
      values.push_back(scan.at(p));
    std::vector<double> means(n);
    for (std::size_t k = 0; k < n; ++k)
    {
      const std::size_t begin = k >= kSmoothed ? k - kSmoothed : 0;
      const std::size_t end = std::min(n, k + kSmoothed + 1);
      for (std::size_t q = begin; q < end; ++q)
        means[k] += values[q] / static_cast<double>(end - begin);
    }
    sides.assign(n, lumen);
    double most = -1e30;
    for (std::size_t k = 0; k < n; ++k)
    {
      most = std::max(most, means[k]);
      sides[k] = std::min(sides[k], most);
    }
    most = -1e30;
    for (std::size_t k = n; k-- > 0;)
    {
      most = std::max(most, means[k]);
      sides[k] = std::min(sides[k], most);
    }
  }

  double depth(std::size_t k) const { return sides[k] - values[k]; }

  /** Value in the middle between a dark point and its sides. */
  double bright(std::size_t k) const { return values[k] + 0.5 * depth(k); }
};

/** Largest radius of the lumen at some points of a path [m]. */
double widthBeside(const Scan& scan, const std::vector<Eigen::Vector3d>& path, std::size_t first, std::size_t last,
                   const LumenRange& range)
{
  double radius = 0.0;
  for (std::size_t k = first; k <= std::min(last, path.size() - 1); ++k)
    radius = std::max(radius, lumenRadius(scan, path[k], range.threshold()));
  return radius;
}

/** True if the path crosses a wall at its darkest point of a dark place. */
bool isCrossing(const Scan& scan, const std::vector<Eigen::Vector3d>& path, const Profile& profile, std::size_t darkest,
                const LumenRange& range)
{
  Values values{profile.bright(darkest), 1e30};
  if (scan.modality() == image::Modality::kCt)
    values.most = range.high + kCalcium * range.width();
  std::size_t a = darkest;
  std::size_t b = darkest;
  while (a > 0 && profile.values[a] < values.least)
    --a;
  while (b + 1 < path.size() && profile.values[b] < values.least)
    ++b;
  const Eigen::Vector3i from = scan.voxelOf(path[a]);
  const Eigen::Vector3i to = scan.voxelOf(path[b]);
  if (from == to)
    return false;
  const double radius =
      std::max(scan.spacing().maxCoeff(), std::min(widthBeside(scan, path, a > kInwards ? a - kInwards : 0, a, range),
                                                   widthBeside(scan, path, b, b + kInwards, range)));
  const Eigen::Vector3d centre = 0.5 * (path[a] + path[b]);
  if (isConnectedWithin(scan, from, to, values, centre, 0.5 * (path[b] - path[a]).norm() + kOwnLumen * radius))
    return false;
  const auto passesBy = [&](const Eigen::Vector3i& side) { return armsOf(scan, side, values, centre, radius) > 1; };
  return (passesBy(from) && passesBy(to)) || isConnected(scan, from, to, values);
}

}  // namespace

std::optional<WallCrossing> wallCrossing(const Scan& scan, const std::vector<Eigen::Vector3d>& path,
                                         const LumenRange& range)
{
  const Profile profile(scan, path, range.low);
  const double least = kDip * (range.low - range.background);
  for (std::size_t k = 0; k < path.size(); ++k)
  {
    if (profile.depth(k) < least)
      continue;
    std::size_t darkest = k;
    for (; k < path.size() && profile.depth(k) >= least; ++k)
      if (profile.depth(k) > profile.depth(darkest))
        darkest = k;
    if (isCrossing(scan, path, profile, darkest, range))
      return WallCrossing{path[darkest], profile.bright(darkest)};
  }
  return std::nullopt;
}

}  // namespace endovascular_sim::segmentation
