#include "segmentation/lumen/ray_edges.h"

#include <algorithm>
#include <cmath>

#include "segmentation/lumen/median.h"

namespace endovascular_sim::segmentation
{
namespace
{

constexpr double kBeyond = 1.8e-3;       ///< length of a profile beyond the longest edge [m]
constexpr double kLumenWindow = 0.01;    ///< on both sides in the running median of the lumen's value [m]
constexpr double kThroat = 0.75;         ///< of the contrast: in a darker middle, the blur does not resolve the lumen
constexpr double kDarkestThroat = 0.05;  ///< of the contrast: an occlusion is darker
constexpr double kWide = 4e-3;           ///< radius from which the lumen may be uneven across a section [m]
constexpr double kWideSpreads = 5.0;     ///< likewise, in standard deviations of the blur
constexpr int kBackgroundWindow = 5;     ///< sections on both sides that share a background
constexpr double kDark = 0.7;            ///< of the lumen: values below may be background
constexpr double kLeastDark = 0.1;       ///< share of such values around a section that has a background
constexpr double kDarkest = 0.25;        ///< least value of the lumen before an edge, in those of the middle
constexpr double kBrightest = 2.0;       ///< largest one
constexpr double kFallsTo = 0.4;         ///< of the local contrast: a profile that stays above has no edge
constexpr double kGap = 2e-3;            ///< farthest bone behind an edge, and its largest thickness [m]
constexpr double kGapDepth = 0.25;       ///< of the contrast: least depth of a soft gap before bone
constexpr int kVoteRays = 2;             ///< rays on both sides that decide between plaque and bone
constexpr int kVoteSections = 4;         ///< sections on both sides, likewise

}  // namespace

RayEdges::RayEdges(const Scan& scan, const std::vector<Section>& sections, double step, double pitch,
                   const EdgeSettings& settings)
  : scan_(scan), sections_(sections), step_(step), pitch_(pitch), settings_(settings)
{
  readProfiles();
  smoothProfiles();
  lumen_.assign(sections.size(), 0.0);
  background_.assign(sections.size(), settings.wall_value);
  edges_.radii.assign(sections.size(), {});
  edges_.ends.assign(sections.size(), {});
  before_bone_.assign(sections.size(), {});
}

void RayEdges::readProfiles()
{
  std::size_t total = 0;
  for (const Section& section : sections_)
  {
    samples_.push_back(static_cast<int>((section.reach + kBeyond) / pitch_) + 1);
    offsets_.push_back(total);
    total += static_cast<std::size_t>(samples_.back()) * kRays;
  }
  profiles_.reserve(total);
  for (std::size_t k = 0; k < sections_.size(); ++k)
    for (int ray = 0; ray < kRays; ++ray)
    {
      const Eigen::Vector3d direction = sections_[k].direction(ray);
      for (int j = 0; j < samples_[k]; ++j)
        profiles_.push_back(static_cast<float>(scan_.at(sections_[k].centre + j * pitch_ * direction)));
    }
}

/** Means over the neighbouring rays of the neighbouring sections. */
void RayEdges::smoothProfiles()
{
  smoothed_ = profiles_;
  const auto n = static_cast<std::ptrdiff_t>(sections_.size());
  for (std::ptrdiff_t k = 0; k < n; ++k)
  {
    const auto section = static_cast<std::size_t>(k);
    for (int ray = 0; ray < kRays; ++ray)
      for (int j = 0; j < samples_[section]; ++j)
      {
        float sum = 0.0F;
        float count = 0.0F;
        for (std::ptrdiff_t q = std::max<std::ptrdiff_t>(0, k - 1); q <= std::min(n - 1, k + 1); ++q)
          for (int b = -1; b <= 1 && j < samples_[static_cast<std::size_t>(q)]; ++b)
          {
            sum += profile(static_cast<std::size_t>(q), (ray + b + kRays) % kRays, j);
            count += 1.0F;
          }
        smoothed_[indexOf(section, ray, j)] = sum / count;
      }
  }
}

EdgeModel RayEdges::modelOf(const Section& section) const
{
  return {section.blur, settings_.wall};
}

void RayEdges::find(const std::vector<double>& radius)
{
  findLumen(radius);
  findBackground(radius);
  for (std::size_t k = 0; k < sections_.size(); ++k)
    findEdges(k, radius[k]);
  if (settings_.calcium > 0.0)
    separateBoneFromPlaque();
}

double RayEdges::shareInMiddle(std::size_t section) const
{
  return (middleOf(section) - background_[section]) / (lumen_[section] - background_[section]);
}

void RayEdges::limitToThroats(std::vector<double>& radius) const
{
  for (std::size_t k = 0; k < sections_.size(); ++k)
    if (const double share = shareInMiddle(k); share < kThroat)
      radius[k] = std::min(radius[k], modelOf(sections_[k]).radiusOfMiddle(std::max(share, kDarkestThroat)));
}

/** Value in the middle of a section. */
double RayEdges::middleOf(std::size_t section) const
{
  const int ring = std::max(1, static_cast<int>(2e-4 / pitch_));
  std::vector<double> values;
  for (int ray = 0; ray < kRays; ray += 4)
    values.push_back(profile(section, ray, ring));
  return 0.5 * (median(values) + profile(section, 0, 0));
}

void RayEdges::findLumen(const std::vector<double>& radius)
{
  const std::size_t n = sections_.size();
  std::vector<double> middle(n);
  std::vector<double> share(n);
  for (std::size_t k = 0; k < n; ++k)
  {
    middle[k] = middleOf(k);
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
  }
}

/** Median of the values around the sections that are darker than the lumen. A surrounding without such values, e.g.
 *  within another lumen, has the background of its darkest values. */
void RayEdges::findBackground(const std::vector<double>& radius)
{
  if (settings_.wall > 0.0)  // the wall is the background of a CT
    return;
  const auto n = static_cast<std::ptrdiff_t>(sections_.size());
  for (std::ptrdiff_t k = 0; k < n; ++k)
  {
    std::vector<double> all;
    std::vector<double> dark;
    for (std::ptrdiff_t q = std::max<std::ptrdiff_t>(0, k - kBackgroundWindow);
         q <= std::min(n - 1, k + kBackgroundWindow); ++q)
    {
      const auto s = static_cast<std::size_t>(q);
      const double from = std::min(radius[s] + 2.0 * modelOf(sections_[s]).spread(), 0.8 * sections_[s].reach);
      for (int ray = 0; ray < kRays; ray += 2)
        for (int j = static_cast<int>(from / pitch_); j < samples_[s]; j += 4)
        {
          const double value = profile(s, ray, j);
          all.push_back(value);
          if (value < kDark * lumen_[s])
            dark.push_back(value);
        }
    }
    const bool is_dark = static_cast<double>(dark.size()) > kLeastDark * static_cast<double>(all.size());
    if (!is_dark)
    {
      const auto tenth = all.begin() + static_cast<std::ptrdiff_t>(all.size() / 10);
      std::nth_element(all.begin(), tenth, all.end());
    }
    background_[static_cast<std::size_t>(k)] =
        std::min(is_dark ? median(dark) : all[all.size() / 10], kDark * lumen_[static_cast<std::size_t>(k)]);
  }
}

/** Mean of a profile between two radii. */
double RayEdges::meanOf(const std::vector<float>& profiles, std::size_t section, int ray, double from, double to) const
{
  const int samples = samples_[section];
  const int begin = std::clamp(static_cast<int>(from / pitch_), 0, samples - 2);
  const int end = std::clamp(static_cast<int>(to / pitch_) + 1, begin + 1, samples);
  const float* profile = &profiles[indexOf(section, ray, 0)];
  double sum = 0.0;
  for (int j = begin; j < end; ++j)
    sum += profile[j];
  return sum / (end - begin);
}

/** Least mean over one standard deviation of the blur, within four behind a radius. */
double RayEdges::darkestBehind(std::size_t section, int ray, double radius, double spread) const
{
  double least = 1e30;
  for (double offset = 0.5; offset < 3.1; offset += 0.5)
    least = std::min(least,
                     meanOf(wideProfiles(), section, ray, radius + offset * spread, radius + (offset + 1.0) * spread));
  return least;
}

/** Value of the lumen at an edge, by three windows before it. The last one is too dark where the ray grazes the edge.
 *  The first two tell such a ray from a signal that falls along it. Without Hounsfield units, the signal is
 * extrapolated to the edge. */
double RayEdges::lumenBefore(std::size_t section, int ray, double radius, double spread) const
{
  const bool is_ct = settings_.wall > 0.0;
  const double even = lumen_[section];
  if (radius < 4.0 * spread)
    return even;
  const auto window = [&](double from)
  {
    const double begin = std::max(0.0, radius - from * spread);
    return meanOf(wideProfiles(), section, ray, begin, begin + 2.0 * spread);
  };
  const double last = window(4.0);
  const double former = window(7.0);
  const double fall = window(10.0) - former;
  if (is_ct)
    return std::min(std::max(last, former - std::max(0.0, fall)), kBrightest * even);
  return std::clamp(std::max(last - fall, former - 2.0 * fall), kDarkest * even, kBrightest * even);
}

/** Value at the edge of a ray. */
double RayEdges::threshold(std::size_t section, int ray, double radius, const EdgeModel& model) const
{
  const double lumen = lumen_[section];
  const double spread = model.spread();
  const double from = radius + settings_.wall + spread;
  const double beyond = meanOf(profiles_, section, ray, from, from + 2.0 * spread);
  if (settings_.wall <= 0.0)  // no wall: the surrounding borders on the lumen
  {
    const double outside = std::min(beyond, kDark * lumen);
    return settings_.half_maximum ? 0.5 * (lumen + outside) : outside + (lumen - outside) * model.discAtEdge(radius);
  }
  if (settings_.half_maximum)
    return 0.5 * (lumen + settings_.wall_value);
  return model.edgeValue(radius, lumen, settings_.wall_value, std::min(beyond, lumen));
}

double RayEdges::calciumLevel(std::size_t section) const
{
  if (settings_.calcium <= 0.0)
    return 1e30;
  return lumen_[section] + std::max(150.0, 0.5 * (settings_.calcium - lumen_[section]));
}

RayEdges::Crossing RayEdges::crossingAt(const std::vector<float>& profiles, std::size_t section, int ray, int sample,
                                        double level, bool rises) const
{
  const float* profile = &profiles[indexOf(section, ray, 0)];
  const double before = profile[sample - 1];
  const double step = profile[sample] - before;
  const double part = step != 0.0 ? std::clamp((level - before) / step, 0.0, 1.0) : 0.0;
  return {pitch_ * (sample - 1 + part), sample, rises};
}

RayEdges::Crossing RayEdges::crossingOfEvenLumen(std::size_t section, int ray, double radius,
                                                 const EdgeModel& model) const
{
  const double edge = threshold(section, ray, radius, model);
  const double calcium = calciumLevel(section);
  const int last = std::min(samples_[section], static_cast<int>(sections_[section].reach / pitch_) + 1);
  for (int j = 1; j < last; ++j)
  {
    const double here = profile(section, ray, j);
    const bool rises = here > calcium;
    if (rises || here < edge)
      return crossingAt(profiles_, section, ray, j, rises ? calcium : edge, rises);
  }
  return {};
}

/** Crossing in a lumen whose value differs across the section. */
RayEdges::Crossing RayEdges::crossingOfWideLumen(std::size_t section, int ray, double radius,
                                                 const EdgeModel& model) const
{
  const double spread = model.spread();
  const double calcium = calciumLevel(section);
  const double background = background_[section];
  const int last = std::min(samples_[section], static_cast<int>(sections_[section].reach / pitch_) + 1);
  const std::vector<float>& profiles = wideProfiles();
  for (int j = 1; j < last; ++j)
  {
    const double here = profiles[indexOf(section, ray, j)];
    if (here > calcium)
      return crossingAt(profiles_, section, ray, j, calcium, true);
    const double r = pitch_ * j;
    const double lumen = lumenBefore(section, ray, r, spread);
    if (here > background + 0.8 * (lumen - background))
      continue;
    const double darkest = darkestBehind(section, ray, r, spread);
    const double falls_to = background + kFallsTo * (lumen - background);
    if (darkest > falls_to)
      continue;
    const double from = r + (settings_.wall > 0.0 ? settings_.wall + spread : 2.0 * spread);
    const double beyond = meanOf(profiles, section, ray, from, from + 2.0 * spread);
    const double outside = beyond < falls_to ? beyond : darkest;
    const double edge = settings_.wall > 0.0
                            ? model.edgeValue(radius, lumen, settings_.wall_value, std::min(beyond, lumen))
                            : outside + (lumen - outside) * model.discAtEdge(radius);
    if (here < edge)
    {
      Crossing crossing = crossingAt(profiles, section, ray, j, edge, false);
      if (settings_.wall <= 0.0)
        crossing.radius = 0.5 * (crossing.radius + lastCrossing(profiles, section, ray, j, edge));
      return crossing;
    }
  }
  return {};
}

/** Last point up to two standard deviations of the blur at which a profile falls below a level. Noise displaces the
 * first such point inwards, and the last one outwards. */
double RayEdges::lastCrossing(const std::vector<float>& profiles, std::size_t section, int ray, int first,
                              double level) const
{
  int last = first;
  const int end = std::min(samples_[section] - 1, first + static_cast<int>(2.0 * sections_[section].blur / pitch_));
  for (int j = first + 1; j <= end; ++j)
    if (profiles[indexOf(section, ray, j)] < level && profiles[indexOf(section, ray, j - 1)] >= level)
      last = j;
  return crossingAt(profiles, section, ray, last, level, false).radius;
}

/** Edge of the lumen before a soft gap and bone, whose blur adds to the value at the edge.
 *  @return [m]; −1 without a gap or without bone */
double RayEdges::beforeBone(std::size_t section, int ray, double radius, const Crossing& crossing,
                            const EdgeModel& model) const
{
  const int range = static_cast<int>(kGap / pitch_);
  const int samples = samples_[section];
  const double calcium = calciumLevel(section);
  const double wall = settings_.wall_value;
  int bone = crossing.sample;
  while (bone < std::min(samples, crossing.sample + range) && profile(section, ray, bone) <= calcium)
    ++bone;
  if (bone >= std::min(samples, crossing.sample + range))
    return -1.0;
  const int begin = std::max(1, bone - range);
  double darkest = 1e30;
  for (int j = begin; j < bone; ++j)
    darkest = std::min<double>(darkest, smoothed_[indexOf(section, ray, j)]);
  if (darkest > lumen_[section] - kGapDepth * (lumen_[section] - wall))
    return -1.0;
  double brightest = settings_.calcium;
  for (int j = bone; j < std::min(samples, bone + range); ++j)
    brightest = std::max<double>(brightest, smoothed_[indexOf(section, ray, j)]);
  const double half = 0.5 * (brightest + wall);
  int surface = bone;
  while (surface > 1 && profile(section, ray, surface) > half)
    --surface;
  while (surface + 1 < samples && profile(section, ray, surface) < half)
    ++surface;
  const double edge = model.edgeValue(radius, lumen_[section], wall, wall);
  for (int j = begin; j < bone; ++j)
  {
    const double level = edge + (brightest - wall) * model.beyondGap(pitch_ * (surface - j));
    if (profile(section, ray, j) < level)
      return crossingAt(profiles_, section, ray, j, level, false).radius;
  }
  return -1.0;
}

bool RayEdges::isWide(std::size_t section, double radius) const
{
  return !settings_.half_maximum && radius > std::max(kWide, kWideSpreads * sections_[section].blur);
}

void RayEdges::findEdges(std::size_t section, double radius)
{
  const EdgeModel model = modelOf(sections_[section]);
  const bool is_wide = isWide(section, radius);
  for (int ray = 0; ray < kRays; ++ray)
  {
    const Crossing crossing =
        is_wide ? crossingOfWideLumen(section, ray, radius, model) : crossingOfEvenLumen(section, ray, radius, model);
    const auto r = static_cast<std::size_t>(ray);
    edges_.radii[section][r] = crossing.radius;
    edges_.ends[section][r] = crossing.radius < 0.0 ? RayEnd::kOpen : crossing.rises ? RayEnd::kCalcium : RayEnd::kWall;
    before_bone_[section][r] = crossing.rises ? beforeBone(section, ray, radius, crossing, model) : -1.0;
  }
}

/** Rays that rise to calcium end at a plaque, or before bone, as most of such rays around them do. */
void RayEdges::separateBoneFromPlaque()
{
  const auto n = static_cast<std::ptrdiff_t>(sections_.size());
  const RayTable before = edges_;
  for (std::ptrdiff_t k = 0; k < n; ++k)
    for (int ray = 0; ray < kRays; ++ray)
    {
      const auto s = static_cast<std::size_t>(k);
      const auto r = static_cast<std::size_t>(ray);
      const double gap = before_bone_[s][r];
      if (before.ends[s][r] != RayEnd::kCalcium)
        continue;
      int bone = 0;
      int plaque = 0;
      for (std::ptrdiff_t q = std::max<std::ptrdiff_t>(0, k - kVoteSections); q <= std::min(n - 1, k + kVoteSections);
           ++q)
        for (int b = -kVoteRays; b <= kVoteRays; ++b)
        {
          const auto at = static_cast<std::size_t>((ray + b + kRays) % kRays);
          const bool has_gap = before_bone_[static_cast<std::size_t>(q)][at] >= 0.0;
          bone += has_gap ? 1 : 0;
          plaque += !has_gap && before.ends[static_cast<std::size_t>(q)][at] == RayEnd::kCalcium ? 1 : 0;
        }
      if (bone <= plaque)
        continue;
      edges_.ends[s][r] = RayEnd::kBone;
      edges_.radii[s][r] = gap;  // −1: its neighbours decide
    }
}

}  // namespace endovascular_sim::segmentation
