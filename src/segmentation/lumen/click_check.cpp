#include "segmentation/lumen/click_check.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "common/error.h"
#include "common/text/format.h"
#include "segmentation/lumen/contrast.h"
#include "segmentation/lumen/local_lumen.h"

namespace endovascular_sim::segmentation
{
namespace
{

constexpr double kDifferentVessels = 0.3;  ///< difference of the lumen at two clicks, in contrasts, that is reported
constexpr double kWider = 1.6;             ///< bound of the radius, in radii at the widest click
constexpr double kFromNarrow = 3.0;        ///< likewise, at the narrowest one
constexpr double kBoundMargin = 8e-4;      ///< [m]
constexpr double kSearch = 0.01;           ///< radius within which a lumen is proposed [m]

/** Bound of the radius of a lumen that has two radii at its clicks [m]. A click in the parent of a branch is too wide.
 */
double boundOf(double widest, double narrowest)
{
  return std::min(kWider * widest, kFromNarrow * narrowest) + kBoundMargin;
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
    std::vector<double> values = valuesAround(scan_, p, (radius + 2e-3) / 2.0, 3);
    return quantile(values, 0.3);
  }

  /** Nearest point that is as bright as the lumen of the other clicks, and its surroundings are. */
  std::optional<Eigen::Vector3d> nearestLumen(const Eigen::Vector3d& p) const
  {
    const double reference = reference_ > 0.0 ? reference_ : 350.0;
    const double least = is_ct_ ? kSoftTissue + kInLumen * (reference - kSoftTissue) : kInLumen * reference;
    const double most = is_ct_ ? std::min(kMostContrast, 1.5 * reference) : 1e30;
    for (double r = 0.0; r <= kSearch; r += 3e-4)
      for (const Eigen::Vector3d& direction : directionsOfSphere(1 + static_cast<int>(4.0 * M_PI * r * r / 9e-8)))
      {
        const Eigen::Vector3d q = p + r * direction;
        if (!scan_.contains(q) || scan_.at(q) < least || scan_.at(q) > most)
          continue;
        std::vector<double> values = valuesAround(scan_, q, 3e-4, 1);
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
      reject(branch, click,
             std::string("lies in ") + tissueName(value) + " (" + number + " HU), not in the lumen" + proposal(p));
    if (reference_ > 0.0 && value < background + kOnWall * (reference_ - background) && is_ct_)
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
          for (const double value : valuesAround(scan_, p + offset, pitch, 1))
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
      lumen.radius = lumenRadius(scan_, lumen.position, 0.5 * (lumen.value + own));
      if (!is_ct_)
      {
        own = backgroundAt(lumen.position, 1.5 * lumen.radius);
        lumen.radius = lumenRadius(scan_, lumen.position, 0.5 * (lumen.value + own));
      }
      requireLumen(branch, click, lumen.value, own);
      widest = std::max(widest, lumen.radius);
      narrowest = std::min(narrowest, lumen.radius);
      background = std::min(background, own);
      checked.clicks.push_back(lumen);
    }
    checked.background = background;
    checked.given_radius = branch.largest_radius;
    checked.largest_radius = branch.largest_radius > 0.0 ? branch.largest_radius : boundOf(widest, narrowest);
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

LumenRange CheckedBranch::wholeRange() const
{
  LumenRange whole{clicks.front().value, clicks.front().value, background};
  for (const LumenAtClick& click : clicks)
  {
    whole.low = std::min(whole.low, click.value);
    whole.high = std::max(whole.high, click.value);
  }
  return whole;
}

double CheckedBranch::radiusBound(std::size_t first) const
{
  if (isBounded())
    return given_radius;
  const double a = clicks[first].radius;
  const double b = clicks[first + 1].radius;
  return boundOf(std::max(a, b), std::min(a, b));
}

std::vector<CheckedBranch> checkClicks(const Scan& scan, const ClickSet& clicks, std::vector<std::string>& warnings)
{
  return Check(scan, clicks).run(warnings);
}

}  // namespace endovascular_sim::segmentation
