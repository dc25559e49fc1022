#include "segmentation/lumen/lumen_fit.h"

#include <algorithm>
#include <cmath>

#include <Eigen/Geometry>

#include "segmentation/lumen/contour_filter.h"
#include "segmentation/lumen/ray_edges.h"

namespace endovascular_sim::segmentation
{
namespace
{

using Points = std::vector<Eigen::Vector3d>;

constexpr int kRounds = 6;             ///< of centring
constexpr int kPasses = 3;             ///< of edges, with the radius of the former pass
constexpr double kFirstRadius = 0.3;   ///< of the first pass, in reaches
constexpr double kFinestPitch = 1e-4;  ///< least distance of the samples of a profile [m]
constexpr double kPitch = 0.01;        ///< likewise, in lengths of the rays

/** Laplacian smoothing over lengths, with fixed ends.
 *  @param lengths one per point [m] */
void smooth(Points& points, const std::vector<double>& lengths, double step)
{
  const auto roundsOf = [step](double length)
  { return std::max(1, static_cast<int>(std::lround(length * length / (step * step)))); };
  const int rounds = roundsOf(*std::max_element(lengths.begin(), lengths.end()));
  for (int round = 0; round < rounds; ++round)
  {
    const Points before = points;
    for (std::size_t k = 1; k + 1 < points.size(); ++k)
      if (round < roundsOf(lengths[k]))
        points[k] = 0.5 * before[k] + 0.25 * (before[k - 1] + before[k + 1]);
  }
}

/** Lengths over which a path is smoothed, in proportion to the reach of its points; twice as long where the rays were
 *  lengthened, so that wide sections do not fan out [m]. */
std::vector<double> smoothingLengths(const Points& points, const RayReach& reach, double share, double least)
{
  std::vector<double> lengths;
  lengths.reserve(points.size());
  for (const Eigen::Vector3d& p : points)
  {
    const double own = reach.at(p);
    lengths.push_back(std::max(least, share * own * std::clamp(own / reach.length(), 1.0, 2.0)));
  }
  return lengths;
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

/** Sections of a path with their contours. */
std::vector<Section> contoursOf(const Scan& scan, const Points& points, double step, const RayReach& reach,
                                const EdgeSettings& settings, bool throats)
{
  std::vector<Section> sections = framesOf(points);
  std::vector<double> radius;
  for (Section& section : sections)
  {
    section.reach = reach.at(section.centre);
    section.blur = blurAcross(settings, scan.spacing(), section.tangent);
    radius.push_back(kFirstRadius * section.reach);
  }
  RayEdges rays(scan, sections, step, std::max(kFinestPitch, kPitch * reach.length()), settings);
  for (int pass = 0; pass < kPasses; ++pass)
  {
    rays.find(radius);
    radius = medianRadii(sections, rays.edges());
  }
  if (throats && settings.wall > 0.0)
  {
    rays.limitToThroats(radius);
    rays.find(radius);
  }
  RayTable edges = rays.edges();
  dropOutliers(radius, edges);
  for (std::size_t k = 0; k < sections.size(); ++k)
  {
    sections[k].lumen = rays.lumen()[k];
    sections[k].middle = rays.shareInMiddle(k);
  }
  setContours(radius, edges, sections);
  return sections;
}

}  // namespace

RayReach::RayReach(double length, const std::vector<Section>& sections) : length_(length)
{
  for (const Section& section : sections)
  {
    points_.push_back(section.centre);
    reach_.push_back(section.reach);
  }
}

double RayReach::at(const Eigen::Vector3d& p) const
{
  double least = 1e30;
  double reach = length_;
  for (std::size_t k = 0; k < points_.size(); ++k)
    if (const double d = (points_[k] - p).squaredNorm(); d < least)
    {
      least = d;
      reach = reach_[k];
    }
  return reach;
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

std::vector<Section> fitLumen(const Scan& scan, const std::vector<Eigen::Vector3d>& path, const RayReach& reach,
                              const EdgeSettings& settings)
{
  const double length = reach.length();
  const double step = std::clamp(0.1 * length, 5e-4, 2e-3);
  Points points = resample(path, step);
  smooth(points, smoothingLengths(points, reach, 0.4, 0.0), step);
  points = resample(points, step);
  for (int round = 0; round < kRounds; ++round)
  {
    const std::vector<Section> sections = contoursOf(scan, points, step, reach, settings, round + 2 >= kRounds);
    for (std::size_t k = 0; k < points.size(); ++k)
    {
      const double limit = std::max(5e-4, 0.15 * sections[k].reach);
      Eigen::Vector3d shift = sections[k].centroid() - points[k];
      if (shift.norm() > limit)
        shift *= limit / shift.norm();
      points[k] += shift;
    }
    smooth(points, smoothingLengths(points, reach, 0.2, 1e-3), step);
    points = resample(points, step);
  }
  return contoursOf(scan, points, step, reach, settings, true);
}

}  // namespace endovascular_sim::segmentation
