#include "segmentation/lumen/click_check.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "common/error.h"
#include "common/text/format.h"

namespace endovascular_sim::segmentation
{
namespace
{

// Hounsfield units. Contrast-filled blood of a CT angiogram lies between 180 and 800.
constexpr double kAir = -300.0;
constexpr double kFat = -20.0;
constexpr double kLeastContrast = 150.0;
constexpr double kMostContrast = 800.0;
constexpr double kSoftTissue = 60.0;
constexpr double kDifferentVessels = 0.3;  ///< difference of the lumen at two clicks, in contrasts, that is reported
constexpr double kSearch = 0.01;           ///< radius within which a lumen is proposed [m]
constexpr double kFarthestWall = 0.03;     ///< longest ray to the wall [m]

double quantile(std::vector<double>& values, double share)
{
  const auto at = values.begin() + static_cast<std::ptrdiff_t>(share * static_cast<double>(values.size() - 1));
  std::nth_element(values.begin(), at, values.end());
  return *at;
}

/** Values on a cube of points around a point. */
std::vector<double> around(const Scan& scan, const Eigen::Vector3d& p, double pitch, int steps)
{
  std::vector<double> values;
  for (int c = -steps; c <= steps; ++c)
    for (int b = -steps; b <= steps; ++b)
      for (int a = -steps; a <= steps; ++a)
        values.push_back(scan.at(p + pitch * Eigen::Vector3d(a, b, c)));
  return values;
}

double localValue(const Scan& scan, const Eigen::Vector3d& p)
{
  std::vector<double> values = around(scan, p, 2.5e-4, 2);
  return quantile(values, 0.6);
}

/** Directions on a sphere, by the golden angle. */
std::vector<Eigen::Vector3d> sphere(int n)
{
  std::vector<Eigen::Vector3d> directions;
  for (int k = 0; k < n; ++k)
  {
    const double z = 1.0 - (2.0 * k + 1.0) / n;
    const double angle = k * M_PI * (3.0 - std::sqrt(5.0));
    const double r = std::sqrt(1.0 - z * z);
    directions.emplace_back(r * std::cos(angle), r * std::sin(angle), z);
  }
  return directions;
}

double toWall(const Scan& scan, const Eigen::Vector3d& p, const Eigen::Vector3d& direction, double threshold)
{
  for (double s = 0.0; s < kFarthestWall; s += 1e-4)
    if (scan.at(p + s * direction) < threshold)
      return s;
  return kFarthestWall;
}

/** Radius of the lumen: half of the shortest chord through the point. */
double radiusAt(const Scan& scan, const Eigen::Vector3d& p, double threshold)
{
  double shortest = 2.0 * kFarthestWall;
  for (const Eigen::Vector3d& direction : sphere(160))
    if (direction.z() >= 0.0)
      shortest = std::min(shortest, toWall(scan, p, direction, threshold) + toWall(scan, p, -direction, threshold));
  return 0.5 * shortest;
}

/** Corner of the image [m] in whole millimetres. */
std::string cornerText(const Eigen::Vector3d& p)
{
  return formatted("(%.0f, %.0f, %.0f)", 1e3 * p.x(), 1e3 * p.y(), 1e3 * p.z());
}

/** Checks of one set of clicks. */
class Check
{
public:
  Check(const Scan& scan, const ClickSet& clicks) : scan_(scan), clicks_(clicks)
  {
    is_ct_ = scan.modality() == image::Modality::kCt;
  }

  std::vector<CheckedBranch> run(std::vector<std::string>& warnings)
  {
    for (const BranchClicks& branch : clicks_.branches)
      for (const Click& click : branch.clicks)
        requireInside(branch, click);
    findReference();
    std::vector<CheckedBranch> checked;
    for (const BranchClicks& branch : clicks_.branches)
      checked.push_back(checkedBranch(branch, warnings));
    return checked;
  }

private:
  [[noreturn]] void reject(const BranchClicks& branch, const Click& click, const std::string& reason) const
  {
    const auto number = &click - branch.clicks.data() + 1;
    throw InputError(clicks_.file,
                     branch.name + ", click " + std::to_string(number) + " (" + click.where + ")" + " at " +
                         inMillimetres(click.position),
                     reason);
  }

  void requireInside(const BranchClicks& branch, const Click& click) const
  {
    if (scan_.contains(scan_.toGrid(click.position)))
      return;
    const Eigen::AlignedBox3d box = scan_.volume().grid.bounds();
    const Eigen::Vector3d swapped(-click.position.x(), -click.position.y(), click.position.z());
    std::string remedy = "lies outside of the image, which extends from " + cornerText(box.min()) + " to " +
                         cornerText(box.max()) + " mm";
    remedy += scan_.contains(scan_.toGrid(swapped))
                  ? "; as RAS it would lie inside: correct the frame of the clicks (LPS or RAS)"
                  : "; check the frame (LPS or RAS), the unit, and that the clicks belong to this image";
    reject(branch, click, remedy);
  }

  /** Median value of the clicks that lie in contrast. */
  void findReference()
  {
    std::vector<double> values;
    double brightest = -1e30;
    for (const BranchClicks& branch : clicks_.branches)
      for (const Click& click : branch.clicks)
      {
        const double value = localValue(scan_, scan_.toGrid(click.position));
        brightest = std::max(brightest, value);
        if (!is_ct_ || (value > kLeastContrast && value < kMostContrast))
          values.push_back(value);
      }
    if (!values.empty())
      reference_ = quantile(values, 0.5);
    else if (brightest < kLeastContrast)
      requireContrast();
  }

  /** @throws InputError if no voxel of the whole image looks like contrast */
  void requireContrast() const
  {
    std::size_t bright = 0;
    for (const std::int16_t stored : scan_.volume().stored)
    {
      const double value = scan_.volume().scale * stored;
      bright += value > 200.0 && value < kMostContrast ? 1 : 0;
    }
    if (static_cast<double>(bright) < 2e-4 * static_cast<double>(scan_.volume().stored.size()))
      throw InputError(
          clicks_.file, "",
          "no click lies in contrast, and the image holds hardly any (200 to 800 HU); give the series with "
          "contrast agent");
  }

  double backgroundAt(const Eigen::Vector3d& p, double radius) const
  {
    if (is_ct_)
      return kSoftTissue;
    std::vector<double> values = around(scan_, p, (radius + 2e-3) / 2.0, 3);
    return quantile(values, 0.3);
  }

  std::string tissueName(double value) const
  {
    if (value < kAir)
      return "air or lung";
    if (value < kFat)
      return "fat";
    if (value < kLeastContrast)
      return "soft tissue or the wall";
    return "bone, calcium or metal";
  }

  /** Nearest point that is as bright as the lumen of the other clicks, and its surroundings are. */
  std::optional<Eigen::Vector3d> nearestLumen(const Eigen::Vector3d& p) const
  {
    const double reference = reference_ > 0.0 ? reference_ : 350.0;
    const double least = is_ct_ ? kSoftTissue + 0.75 * (reference - kSoftTissue) : 0.75 * reference;
    const double most = is_ct_ ? std::min(kMostContrast, 1.5 * reference) : 1e30;
    for (double r = 0.0; r <= kSearch; r += 3e-4)
      for (const Eigen::Vector3d& direction : sphere(1 + static_cast<int>(4.0 * M_PI * r * r / 9e-8)))
      {
        const Eigen::Vector3d q = p + r * direction;
        if (!scan_.contains(q) || scan_.at(q) < least || scan_.at(q) > most)
          continue;
        std::vector<double> values = around(scan_, q, 3e-4, 1);
        const double darkest = quantile(values, 0.1);
        const double brightest = quantile(values, 0.9);
        if (darkest > least && brightest < most)
          return q;
      }
    return std::nullopt;
  }

  std::string proposal(const Eigen::Vector3d& p) const
  {
    const std::optional<Eigen::Vector3d> lumen = nearestLumen(p);
    if (!lumen)
      return "; there is no lumen within 10 mm: click again";
    return "; the nearest lumen is at " + inMillimetres(scan_.toPatient(*lumen)) +
           formatted(" (%.0f)", scan_.at(*lumen));
  }

  void requireLumen(const BranchClicks& branch, const Click& click, double value, double background) const
  {
    const Eigen::Vector3d p = scan_.toGrid(click.position);
    const std::string number = std::to_string(static_cast<int>(std::lround(value)));
    if (is_ct_ && (value < kLeastContrast || value > kMostContrast))
      reject(branch, click, "lies in " + tissueName(value) + " (" + number + " HU), not in the lumen" + proposal(p));
    if (reference_ > 0.0 && value < background + 0.45 * (reference_ - background) && is_ct_)
      reject(branch, click,
             "lies on the wall (" + number + " HU; the lumen has about " +
                 std::to_string(static_cast<int>(std::lround(reference_))) + " HU)" + proposal(p));
    if (!is_ct_ && value < 1.3 * background)
      reject(branch, click,
             "is not brighter than its surroundings (" + number + " in place of " +
                 std::to_string(static_cast<int>(std::lround(background))) + "): it lies outside of the lumen" +
                 proposal(p));
  }

  /** Brightest place within one voxel of a point. A click at the edge of a vessel gets into it. Only for images without
   * Hounsfield units, in which nothing beside the lumen is brighter. */
  Eigen::Vector3d brightestNear(const Eigen::Vector3d& p) const
  {
    const double range = scan_.spacing().maxCoeff();
    const double pitch = 0.5 * scan_.spacing().minCoeff();
    const int steps = static_cast<int>(range / pitch);
    Eigen::Vector3d best = p;
    double most = -1e30;
    for (int c = -steps; c <= steps; ++c)
      for (int b = -steps; b <= steps; ++b)
        for (int a = -steps; a <= steps; ++a)
        {
          const Eigen::Vector3d offset = pitch * Eigen::Vector3d(a, b, c);
          if (offset.norm() > range || !scan_.contains(p + offset))
            continue;
          double sum = 0.0;
          for (const double value : around(scan_, p + offset, pitch, 1))
            sum += value;
          if (sum > most + 1e-9 * std::abs(most))
          {
            most = sum;
            best = p + offset;
          }
        }
    return best;
  }

  CheckedBranch checkedBranch(const BranchClicks& branch, std::vector<std::string>& warnings) const
  {
    CheckedBranch checked;
    checked.name = branch.name;
    double widest = 0.0;
    double narrowest = 1e30;
    double background = 1e30;
    for (const Click& click : branch.clicks)
    {
      LumenAtClick lumen;
      constexpr double kResolution = 1e-6;  // m; the formats of images round their origin differently
      lumen.position = (scan_.toGrid(click.position) / kResolution).array().round() * kResolution;
      if (!is_ct_)
        lumen.position = brightestNear(lumen.position);
      lumen.value = localValue(scan_, lumen.position);
      double own = backgroundAt(lumen.position, 5e-3);
      lumen.radius = radiusAt(scan_, lumen.position, 0.5 * (lumen.value + own));
      if (!is_ct_)
      {
        own = backgroundAt(lumen.position, 1.5 * lumen.radius);
        lumen.radius = radiusAt(scan_, lumen.position, 0.5 * (lumen.value + own));
      }
      requireLumen(branch, click, lumen.value, own);
      widest = std::max(widest, lumen.radius);
      narrowest = std::min(narrowest, lumen.radius);
      background = std::min(background, own);
      checked.clicks.push_back(lumen);
    }
    checked.background = background;
    checked.largest_radius =
        branch.largest_radius > 0.0 ? branch.largest_radius : std::min(1.6 * widest, 3.0 * narrowest) + 8e-4;
    const double first = checked.clicks.front().value;
    const double last = checked.clicks.back().value;
    if (is_ct_ && std::abs(first - last) > kDifferentVessels * (std::max(first, last) - background))
      warnings.push_back(branch.name + ": the lumen has " + std::to_string(static_cast<int>(first)) +
                         " HU at the first click and " + std::to_string(static_cast<int>(last)) +
                         " HU at the last one: check that both lie in the same vessel");
    return checked;
  }

  const Scan& scan_;
  const ClickSet& clicks_;
  bool is_ct_;
  double reference_ = 0.0;  ///< value of the lumen; 0: unknown
};

}  // namespace

LumenRange CheckedBranch::range(std::size_t first) const
{
  const double a = clicks[first].value;
  const double b = clicks[first + 1].value;
  return {std::min(a, b), std::max(a, b), background};
}

std::vector<CheckedBranch> checkClicks(const Scan& scan, const ClickSet& clicks, std::vector<std::string>& warnings)
{
  return Check(scan, clicks).run(warnings);
}

}  // namespace endovascular_sim::segmentation
