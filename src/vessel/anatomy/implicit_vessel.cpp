#include "vessel/anatomy/implicit_vessel.h"

#include <algorithm>
#include <cmath>

namespace endovascular_sim::vessel
{
namespace
{

constexpr std::size_t kClusterSize = 12;
/** Gradation: growth of the edge length per distance from a finer branch. */
constexpr double kEdgeGrowth = 0.25;

/** Smooth minimum of a and b with its gradient, stored in a. It is at most range/6 below min(a, b), at a = b. */
void smoothMinimum(double& a, Eigen::Vector3d& a_gradient, double b, const Eigen::Vector3d& b_gradient, double range)
{
  const double h = std::max(range - std::abs(a - b), 0.0) / range;
  const double weight = 0.5 * h * h;  // of the larger argument's gradient
  a_gradient = a < b ? Eigen::Vector3d((1.0 - weight) * a_gradient + weight * b_gradient)
                     : Eigen::Vector3d((1.0 - weight) * b_gradient + weight * a_gradient);
  a = std::min(a, b) - h * h * h * range / 6.0;
}

/** Cubic Hermite segment of the axis between two samples. */
struct AxisSegment
{
  Eigen::Vector3d p0, m0, p1, m1;

  Eigen::Vector3d position(double t) const
  {
    const double s = 1.0 - t;
    return (1.0 + 2.0 * t) * s * s * p0 + t * s * s * m0 + (3.0 - 2.0 * t) * t * t * p1 - t * t * s * m1;
  }
  Eigen::Vector3d first(double t) const
  {
    return 6.0 * t * (1.0 - t) * (p1 - p0) + (1.0 - t) * (1.0 - 3.0 * t) * m0 + t * (3.0 * t - 2.0) * m1;
  }
  Eigen::Vector3d second(double t) const
  {
    return 6.0 * (1.0 - 2.0 * t) * (p1 - p0) + (6.0 * t - 4.0) * m0 + (6.0 * t - 2.0) * m1;
  }
};

}  // namespace

ImplicitVessel::ImplicitVessel(const Anatomy& anatomy, std::vector<AnatomyChain> chains)
  : blend_(anatomy.blend),
    facet_per_radius_(2.0 * M_PI / anatomy.facets_around),
    longest_facet_(anatomy.longest_facet),
    bulges_(anatomy.bulges)
{
  for (AnatomyChain& chain : chains)
    addTube(std::move(chain));
  for (const Bulge& bulge : bulges_)
  {
    const Eigen::Vector3d reach = Eigen::Vector3d::Constant(bulge.radius);
    bounds_.extend(Eigen::AlignedBox3d(bulge.centre - reach, bulge.centre + reach));
  }
}

void ImplicitVessel::addTube(AnatomyChain chain)
{
  Tube tube;
  tube.chain = std::move(chain);
  const AnatomyChain& c = tube.chain;
  const std::size_t n = c.points.size();
  double narrowest = c.radii.front();
  for (std::size_t k = 0; k < n; ++k)
  {
    const std::size_t before = k > 0 ? k - 1 : k;
    const std::size_t after = k + 1 < n ? k + 1 : k;
    tube.radius_slope.push_back((c.radii[after] - c.radii[before]) / (c.arc[after] - c.arc[before]));
    tube.axis_box.extend(c.points[k]);
    tube.widest = std::max(tube.widest, c.radii[k]);
    narrowest = std::min(narrowest, c.radii[k]);
  }
  tube.facet_per_radius = c.facets_around > 0 ? 2.0 * M_PI / c.facets_around : facet_per_radius_;
  tube.shortest_edge = edgeLengthFor(tube, narrowest);
  for (std::size_t begin = 0; begin + 1 < n; begin += kClusterSize)
  {
    Cluster cluster;
    cluster.begin = begin;
    cluster.end = std::min(begin + kClusterSize, n - 1);
    cluster.centre = 0.5 * (c.points[begin] + c.points[cluster.end]);
    for (std::size_t k = begin; k <= cluster.end; ++k)
    {
      // Bound of the distance between the curved axis and its chord.
      const double sagitta = k > begin ? 0.25 * (c.points[k] - c.points[k - 1]).norm() : 0.0;
      cluster.reach = std::max(cluster.reach, (c.points[k] - cluster.centre).norm() + sagitta);
      cluster.widest = std::max(cluster.widest, c.radii[k]);
    }
    tube.clusters.push_back(cluster);
  }
  const Eigen::Vector3d reach = Eigen::Vector3d::Constant(tube.widest);
  bounds_.extend(Eigen::AlignedBox3d(tube.axis_box.min() - reach, tube.axis_box.max() + reach));
  tubes_.push_back(std::move(tube));
}

double ImplicitVessel::edgeLengthFor(const Tube& tube, double radius) const
{
  return std::min(tube.facet_per_radius * radius, longest_facet_);
}

ImplicitVessel::TubeSample ImplicitVessel::sampleTube(const Tube& tube, const Eigen::Vector3d& p) const
{
  const AnatomyChain& c = tube.chain;
  double best_squared = 1e300;
  std::size_t best = 0;
  double best_t = 0.0;
  for (const Cluster& cluster : tube.clusters)
  {
    const double nearest = (p - cluster.centre).norm() - cluster.reach;
    if (nearest > 0.0 && nearest * nearest >= best_squared)
      continue;
    for (std::size_t k = cluster.begin; k < cluster.end; ++k)
    {
      const Eigen::Vector3d chord = c.points[k + 1] - c.points[k];
      const double t = std::clamp((p - c.points[k]).dot(chord) / chord.squaredNorm(), 0.0, 1.0);
      const double squared = (c.points[k] + t * chord - p).squaredNorm();
      if (squared < best_squared)
      {
        best_squared = squared;
        best = k;
        best_t = t;
      }
    }
  }

  // Newton's method on (p − c(t))·c'(t) = 0 along the smooth axis c, with transition into adjacent segments.
  double t = best_t;
  std::size_t k = best;
  Eigen::Vector3d foot;
  for (int step = 0; step < 4; ++step)
  {
    const double length = c.arc[k + 1] - c.arc[k];
    const AxisSegment axis{c.points[k], length * c.tangents[k], c.points[k + 1], length * c.tangents[k + 1]};
    foot = axis.position(t);
    const Eigen::Vector3d along = axis.first(t);
    const double slope = (foot - p).dot(along);
    const double curvature = std::max(along.squaredNorm() + (foot - p).dot(axis.second(t)), 0.2 * along.squaredNorm());
    t -= slope / curvature;
    if (t < 0.0 && k > 0)
      --k, t = std::clamp(t + 1.0, 0.0, 1.0);
    else if (t > 1.0 && k + 2 < c.points.size())
      ++k, t = std::clamp(t - 1.0, 0.0, 1.0);
    t = std::clamp(t, 0.0, 1.0);
  }
  const double length = c.arc[k + 1] - c.arc[k];
  const AxisSegment axis{c.points[k], length * c.tangents[k], c.points[k + 1], length * c.tangents[k + 1]};
  foot = axis.position(t);

  const double s = 1.0 - t;
  TubeSample sample;
  sample.radius = (1.0 + 2.0 * t) * s * s * c.radii[k] + t * s * s * length * tube.radius_slope[k] +
                  (3.0 - 2.0 * t) * t * t * c.radii[k + 1] - t * t * s * length * tube.radius_slope[k + 1];
  const Eigen::Vector3d outward = p - foot;
  const double off_axis = outward.norm();
  sample.distance = off_axis - sample.radius;
  if (off_axis > 0.0)
    sample.gradient = outward / off_axis;
  return sample;
}

FieldSample ImplicitVessel::at(const Eigen::Vector3d& p) const
{
  FieldSample field;
  field.distance = 1e300;
  field.edge_length = longest_facet_;
  for (const Tube& tube : tubes_)
  {
    const double lower_bound = tube.axis_box.exteriorDistance(p) - tube.widest;
    const bool far_from_wall = lower_bound >= field.distance + blend_ * tube.widest;
    const bool has_longer_edges = tube.shortest_edge + kEdgeGrowth * std::max(lower_bound, 0.0) >= field.edge_length;
    if (far_from_wall && has_longer_edges)
      continue;
    const TubeSample sample = sampleTube(tube, p);
    const double edge_length = edgeLengthFor(tube, sample.radius) + kEdgeGrowth * std::max(sample.distance, 0.0);
    field.edge_length = std::min(field.edge_length, edge_length);
    smoothMinimum(field.distance, field.gradient, sample.distance, sample.gradient, blend_ * sample.radius);
  }
  for (const Bulge& bulge : bulges_)
  {
    const Eigen::Vector3d outward = p - bulge.centre;
    const double distance = outward.norm();
    smoothMinimum(field.distance, field.gradient, distance - bulge.radius,
                  distance > 0.0 ? Eigen::Vector3d(outward / distance) : Eigen::Vector3d(Eigen::Vector3d::UnitZ()),
                  bulge.blend * bulge.radius);
  }
  return field;
}

}  // namespace endovascular_sim::vessel
