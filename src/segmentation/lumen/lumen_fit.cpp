#include "segmentation/lumen/lumen_fit.h"

#include <algorithm>
#include <cmath>

#include <Eigen/Geometry>

#include "segmentation/lumen/edge_model.h"

namespace endovascular_sim::segmentation
{
namespace
{

using Points = std::vector<Eigen::Vector3d>;

constexpr int kRounds = 6;             ///< of centring
constexpr int kHarmonics = 4;          ///< of the contours
constexpr int kWindow = 2;             ///< sections and rays on both sides in the medians of the contours
constexpr double kLumenWindow = 0.01;  ///< on both sides in the running median of the lumen's value [m]
constexpr int kRadiusWindow = 5;       ///< sections on both sides in the median radius
constexpr double kBeyond = 1.8e-3;     ///< length of a profile beyond the largest radius [m]

double median(std::vector<double>& values)
{
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

/** Laplacian smoothing over a length, with fixed ends. */
void smooth(Points& points, double length, double step)
{
  const int rounds = std::max(1, static_cast<int>(std::lround(length * length / (step * step))));
  for (int round = 0; round < rounds; ++round)
  {
    const Points before = points;
    for (std::size_t k = 1; k + 1 < points.size(); ++k)
      points[k] = 0.5 * before[k] + 0.25 * (before[k - 1] + before[k + 1]);
  }
}

/** Sections of a path without contours, in a rotation-minimising frame. The first ray is the projection of the grid
 * axis that is most perpendicular to the path. */
std::vector<Section> framesOf(const Points& points)
{
  std::vector<Section> sections(points.size());
  Eigen::Vector3d u = Eigen::Vector3d::Zero();
  for (std::size_t k = 0; k < points.size(); ++k)
  {
    Section& section = sections[k];
    section.centre = points[k];
    const std::size_t before = k >= 2 ? k - 2 : 0;
    const std::size_t after = std::min(points.size() - 1, k + 2);
    section.tangent = (points[after] - points[before]).normalized();
    if (k == 0)
    {
      int axis = 0;
      section.tangent.cwiseAbs().minCoeff(&axis);
      u = Eigen::Vector3d::Unit(axis);
    }
    section.u = (u - section.tangent * u.dot(section.tangent)).normalized();
    section.w = section.tangent.cross(section.u);
    u = section.u;
  }
  return sections;
}

/** Contours of the sections of one path. */
class Contours
{
public:
  Contours(const Scan& scan, const Points& points, double step, double largest_radius, const EdgeSettings& settings)
    : scan_(scan),
      settings_(settings),
      sections_(framesOf(points)),
      step_(step),
      largest_(largest_radius),
      pitch_(std::max(1e-4, 0.01 * largest_radius)),
      samples_(static_cast<int>((largest_radius + kBeyond) / pitch_) + 1)
  {
  }

  std::vector<Section> run()
  {
    readProfiles();
    std::vector<double> radius(sections_.size(), 0.3 * largest_);
    lumen_.assign(sections_.size(), 0.0);
    for (int pass = 0; pass < 3; ++pass)
    {
      findLumen(radius);
      for (std::size_t k = 0; k < sections_.size(); ++k)
        findEdges(k, radius[k]);
      radius = medianRadii();
    }
    dropOutliers(radius);
    for (std::size_t k = 0; k < sections_.size(); ++k)
      setContour(k, radius[k]);
    return std::move(sections_);
  }

private:
  float& profile(std::size_t section, int ray, int sample)
  {
    return profiles_[(section * kRays + static_cast<std::size_t>(ray)) * static_cast<std::size_t>(samples_) +
                     static_cast<std::size_t>(sample)];
  }

  void readProfiles()
  {
    profiles_.resize(sections_.size() * kRays * static_cast<std::size_t>(samples_));
    edges_.assign(sections_.size(), {});
    for (std::size_t k = 0; k < sections_.size(); ++k)
      for (int ray = 0; ray < kRays; ++ray)
      {
        const Eigen::Vector3d direction = sections_[k].direction(ray);
        for (int j = 0; j < samples_; ++j)
          profile(k, ray, j) = static_cast<float>(scan_.at(sections_[k].centre + j * pitch_ * direction));
      }
  }

  /** Standard deviation of the blur across the section: scanner, voxel, interpolation. */
  EdgeModel modelOf(const Section& section) const
  {
    const Eigen::Vector3d squares = scan_.spacing().cwiseAbs2();
    const double across = 0.5 * (squares.sum() - section.tangent.cwiseAbs2().dot(squares));
    return {std::sqrt(settings_.point_spread * settings_.point_spread + 0.25 * across), settings_.wall};
  }

  /** Value of the lumen: running median of the values in the middle, where the lumen is wide enough to reach its full
   *  value there. */
  void findLumen(const std::vector<double>& radius)
  {
    const std::size_t n = sections_.size();
    std::vector<double> middle(n);
    std::vector<double> share(n);
    const int ring = std::max(1, static_cast<int>(2e-4 / pitch_));
    for (std::size_t k = 0; k < n; ++k)
    {
      std::vector<double> values;
      for (int ray = 0; ray < kRays; ray += 4)
        values.push_back(profile(k, ray, ring));
      middle[k] = 0.5 * (median(values) + profile(k, 0, 0));
      share[k] = modelOf(sections_[k]).discInMiddle(radius[k]);
    }
    const auto window = static_cast<std::ptrdiff_t>(std::ceil(kLumenWindow / step_));
    for (std::size_t k = 0; k < n; ++k)
    {
      std::vector<double> good;
      std::vector<double> all;
      for (std::ptrdiff_t q = -window; q <= window; ++q)
      {
        const std::ptrdiff_t at = static_cast<std::ptrdiff_t>(k) + q;
        if (at < 0 || at >= static_cast<std::ptrdiff_t>(n))
          continue;
        const auto s = static_cast<std::size_t>(at);
        all.push_back(middle[s]);
        if (share[s] > 0.9)
          good.push_back(middle[s] / share[s]);
      }
      lumen_[k] = good.size() > 4 ? median(good) : median(all);
      sections_[k].lumen = lumen_[k];
    }
  }

  /** Mean of a profile between two radii. */
  double meanOf(std::size_t section, int ray, double from, double to)
  {
    const int begin = std::clamp(static_cast<int>(from / pitch_), 0, samples_ - 2);
    const int end = std::clamp(static_cast<int>(to / pitch_) + 1, begin + 1, samples_);
    double sum = 0.0;
    for (int j = begin; j < end; ++j)
      sum += profile(section, ray, j);
    return sum / (end - begin);
  }

  /** Value at the edge of a ray. */
  double threshold(std::size_t section, int ray, double radius, const EdgeModel& model)
  {
    const double lumen = lumen_[section];
    const double spread = model.spread();
    const double from = radius + settings_.wall + spread;
    const double beyond = meanOf(section, ray, from, from + 2.0 * spread);
    if (settings_.wall <= 0.0)  // no wall: the surrounding borders on the lumen
    {
      const double outside = std::min(beyond, 0.7 * lumen);
      return settings_.half_maximum ? 0.5 * (lumen + outside) : outside + (lumen - outside) * model.discAtEdge(radius);
    }
    if (settings_.half_maximum)
      return 0.5 * (lumen + settings_.wall_value);
    return model.edgeValue(radius, lumen, settings_.wall_value, std::min(beyond, lumen));
  }

  void findEdges(std::size_t section, double radius)
  {
    const EdgeModel model = modelOf(sections_[section]);
    const double lumen = lumen_[section];
    const double calcium = lumen + std::max(150.0, 0.5 * (settings_.calcium - lumen));
    const int last = std::min(samples_, static_cast<int>(largest_ / pitch_) + 1);
    int with_calcium = 0;
    for (int ray = 0; ray < kRays; ++ray)
    {
      const double edge = threshold(section, ray, radius, model);
      double& found = edges_[section][static_cast<std::size_t>(ray)];
      found = -1.0;
      for (int j = 1; j < last && found < 0.0; ++j)
      {
        const double before = profile(section, ray, j - 1);
        const double here = profile(section, ray, j);
        const bool rises = settings_.calcium > 0.0 && here > calcium;
        const double level = rises ? calcium : edge;
        if (!rises && here >= edge)
          continue;
        const double step = here - before;
        found = pitch_ * (j - 1 + (step != 0.0 ? std::clamp((level - before) / step, 0.0, 1.0) : 0.0));
        with_calcium += rises ? 1 : 0;
      }
    }
    sections_[section].calcium = static_cast<double>(with_calcium) / kRays;
  }

  /** Median radius of the edges in a window along the path; where no ray has an edge, that of the nearest section with
   *  edges. */
  std::vector<double> medianRadii() const
  {
    const auto n = static_cast<std::ptrdiff_t>(sections_.size());
    std::vector<double> radii(sections_.size(), 0.0);
    for (std::ptrdiff_t window = kRadiusWindow; window < 2 * n; window *= 2)
    {
      bool complete = true;
      for (std::ptrdiff_t k = 0; k < n; ++k)
      {
        if (radii[static_cast<std::size_t>(k)] > 0.0)
          continue;
        std::vector<double> values;
        for (std::ptrdiff_t q = std::max<std::ptrdiff_t>(0, k - window); q <= std::min(n - 1, k + window); ++q)
          for (const double r : edges_[static_cast<std::size_t>(q)])
            if (r > 0.0)
              values.push_back(r);
        if (values.size() > kRays / 2)
          radii[static_cast<std::size_t>(k)] = median(values);
        else
          complete = false;
      }
      if (complete)
        return radii;
    }
    for (double& r : radii)
      r = r > 0.0 ? r : 0.3 * largest_;
    return radii;
  }

  /** Removes edges that do not fit the median radius: side branches, noise in the middle of the lumen. */
  void dropOutliers(const std::vector<double>& radius)
  {
    for (std::size_t k = 0; k < sections_.size(); ++k)
    {
      int kept = 0;
      for (double& r : edges_[k])
      {
        if (r > 1.6 * radius[k] || r < 0.25 * radius[k])
          r = -1.0;
        kept += r > 0.0 ? 1 : 0;
      }
      sections_[k].edges = static_cast<double>(kept) / kRays;
    }
  }

  void setContour(std::size_t section, double radius)
  {
    const auto n = static_cast<std::ptrdiff_t>(sections_.size());
    std::array<double, kRays> filled{};
    std::vector<double> values;
    for (int ray = 0; ray < kRays; ++ray)
    {
      values.clear();
      for (std::ptrdiff_t a = -kWindow; a <= kWindow; ++a)
      {
        const std::ptrdiff_t s = static_cast<std::ptrdiff_t>(section) + a;
        if (s < 0 || s >= n)
          continue;
        for (int b = -kWindow; b <= kWindow; ++b)
        {
          const double r = edges_[static_cast<std::size_t>(s)][static_cast<std::size_t>((ray + b + kRays) % kRays)];
          if (r > 0.0)
            values.push_back(r);
        }
      }
      filled[static_cast<std::size_t>(ray)] = values.size() > 3 ? median(values) : radius;
    }
    std::array<double, kRays>& radii = sections_[section].radii;
    radii.fill(0.0);
    for (int h = 0; h <= kHarmonics; ++h)
    {
      double a = 0.0;
      double b = 0.0;
      const double angle = 2.0 * M_PI * h / kRays;
      for (int ray = 0; ray < kRays; ++ray)
      {
        a += filled[static_cast<std::size_t>(ray)] * std::cos(angle * ray);
        b += filled[static_cast<std::size_t>(ray)] * std::sin(angle * ray);
      }
      const double factor = (h == 0 ? 1.0 : 2.0) / kRays;
      for (int ray = 0; ray < kRays; ++ray)
        radii[static_cast<std::size_t>(ray)] += factor * (a * std::cos(angle * ray) + b * std::sin(angle * ray));
    }
    for (double& r : radii)
      r = std::max(r, 0.1 * radius);
  }

  const Scan& scan_;
  const EdgeSettings& settings_;
  std::vector<Section> sections_;
  double step_;
  double largest_;
  double pitch_;  ///< of the samples of a profile [m]
  int samples_;
  std::vector<float> profiles_;
  std::vector<std::array<double, kRays>> edges_;  ///< −1: none [m]
  std::vector<double> lumen_;
};

}  // namespace

EdgeSettings edgeSettings(image::Modality modality, const Eigen::Vector3d& spacing)
{
  EdgeSettings settings;
  if (modality == image::Modality::kCt)
    return settings;
  settings.point_spread = 0.55 * std::cbrt(spacing.prod());
  settings.wall = 0.0;
  settings.calcium = 0.0;
  return settings;
}

std::vector<Eigen::Vector3d> resample(const std::vector<Eigen::Vector3d>& path, double step)
{
  Points points{path.front()};
  double passed = 0.0;
  for (std::size_t k = 1; k < path.size(); ++k)
  {
    Eigen::Vector3d from = path[k - 1];
    double length = (path[k] - from).norm();
    while (passed + length >= step)
    {
      from += (step - passed) / length * (path[k] - from);
      points.push_back(from);
      length = (path[k] - from).norm();
      passed = 0.0;
    }
    passed += length;
  }
  if (points.size() < 2 || (points.back() - path.back()).norm() > 0.3 * step)
    points.push_back(path.back());
  return points;
}

std::vector<Section> fitLumen(const Scan& scan, const std::vector<Eigen::Vector3d>& path, double largest_radius,
                              const EdgeSettings& settings)
{
  const double step = std::clamp(0.1 * largest_radius, 5e-4, 2e-3);
  Points points = resample(path, step);
  smooth(points, 0.4 * largest_radius, step);
  points = resample(points, step);
  for (int round = 0; round < kRounds; ++round)
  {
    const std::vector<Section> sections = Contours(scan, points, step, largest_radius, settings).run();
    const double limit = std::max(5e-4, 0.15 * largest_radius);
    for (std::size_t k = 0; k < points.size(); ++k)
    {
      Eigen::Vector3d shift = sections[k].centroid() - points[k];
      if (shift.norm() > limit)
        shift *= limit / shift.norm();
      points[k] += shift;
    }
    smooth(points, std::max(1e-3, 0.2 * largest_radius), step);
    points = resample(points, step);
  }
  return Contours(scan, points, step, largest_radius, settings).run();
}

}  // namespace endovascular_sim::segmentation
