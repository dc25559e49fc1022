#include "vessel/anatomy/anatomy.h"

#include <algorithm>
#include <cmath>

#include "common/error.h"
#include "geometry/spline.h"

namespace endovascular_sim::vessel
{
namespace
{

/** Spacing of the centreline's samples, in radii of the lumen. */
constexpr double kSampleSpacing = 0.25;

const AnatomyBranch& branchAt(const Anatomy& anatomy, int index)
{
  return anatomy.branches[static_cast<std::size_t>(index)];
}

double smallestRadius(const AnatomyBranch& branch)
{
  double smallest = 1e300;
  for (const auto& [fraction, diameter] : branch.diameters)
    smallest = std::min(smallest, 0.5 * diameter);
  for (const Stenosis& stenosis : branch.stenoses)
    smallest = std::min({smallest, 0.1 * stenosis.length, smallest * (1.0 - stenosis.reduction)});
  return smallest;
}

struct NearestSample
{
  Eigen::Vector3d point;
  double distance = 1e300;
  double radius = 0.0;
};

/** Sample of a branch's centreline that is nearest to a point. */
NearestSample nearestOnBranch(const AnatomyChain& chain, int branch, const Eigen::Vector3d& p)
{
  const auto part = static_cast<std::size_t>(std::find(chain.branches.begin(), chain.branches.end(), branch) -
                                             chain.branches.begin());
  const std::size_t end = part + 1 < chain.first_sample.size() ? chain.first_sample[part + 1] : chain.points.size() - 1;
  NearestSample nearest;
  for (std::size_t k = chain.first_sample[part]; k <= end; ++k)
    if ((chain.points[k] - p).norm() < nearest.distance)
      nearest = {chain.points[k], (chain.points[k] - p).norm(), chain.radii[k]};
  return nearest;
}

/** Control points of a chain, with the index of the first control point of each branch. */
struct ControlPoints
{
  std::vector<Eigen::Vector3d> points;
  std::vector<std::size_t> begin;
};

ControlPoints controlPoints(const Anatomy& anatomy, const AnatomyChain& chain)
{
  ControlPoints control;
  for (int index : chain.branches)
  {
    std::vector<Eigen::Vector3d> own = branchAt(anatomy, index).points;
    control.begin.push_back(control.points.empty() ? 0 : control.points.size() - 1);
    // A continuation may repeat its parent's last point.
    if (!control.points.empty() && (own.front() - control.points.back()).norm() < 1e-5)
      own.erase(own.begin());
    control.points.insert(control.points.end(), own.begin(), own.end());
  }
  control.begin.push_back(control.points.size() - 1);
  return control;
}

/** Radius of a branch over the fraction of its length, without stenoses.
 *  @param inherited radius at the end of the branch that this branch continues [m] */
geometry::MonotoneCubic radiusProfile(const Anatomy& anatomy, const AnatomyBranch& branch, double inherited)
{
  std::vector<double> fractions;
  std::vector<double> radii;
  for (const auto& [fraction, diameter] : branch.diameters)
  {
    fractions.push_back(fraction);
    radii.push_back(0.5 * diameter);
  }
  if (branch.continues)
  {
    if (fractions.front() > 0.0)
    {
      fractions.insert(fractions.begin(), 0.0);
      radii.insert(radii.begin(), inherited);
    }
    else if (std::abs(radii.front() - inherited) > 1e-3 * inherited)
      throw InputError(anatomy.file, "branches[" + branch.name + "].diameters",
                       "the diameter at fraction 0 must equal the diameter at the end of the continued branch (" +
                           std::to_string(2e3 * inherited) + " mm); remove that entry");
  }
  return {fractions, radii};
}

void applyStenoses(const AnatomyBranch& branch, double length, double along, double& radius)
{
  for (const Stenosis& stenosis : branch.stenoses)
  {
    const double offset = std::abs(along - stenosis.position * length) / stenosis.length;
    if (offset < 0.5)
      radius *= 1.0 - stenosis.reduction * 0.5 * (1.0 + std::cos(2.0 * M_PI * offset));
  }
}

/** Arc length of the spline from u0 to u1 by the composite Simpson rule. */
double arcLength(const geometry::Spline3& spline, double u0, double u1)
{
  const int pieces = std::max(4, static_cast<int>(std::ceil((u1 - u0) / 0.5e-3)));
  double length = 0.0;
  for (int k = 0; k < pieces; ++k)
  {
    const double a = u0 + (u1 - u0) * k / pieces;
    const double b = u0 + (u1 - u0) * (k + 1) / pieces;
    length +=
        (b - a) / 6.0 *
        (spline.derivative(a).norm() + 4.0 * spline.derivative(0.5 * (a + b)).norm() + spline.derivative(b).norm());
  }
  return length;
}

/** Appends the samples of one branch to its chain. Continuations share their first sample with the previous branch. */
void sampleBranch(const Anatomy& anatomy, const AnatomyBranch& branch, const geometry::Spline3& spline, double u0,
                  double u1, AnatomyChain& chain)
{
  const double length = arcLength(spline, u0, u1);
  const double inherited = chain.radii.empty() ? 0.0 : chain.radii.back();
  const geometry::MonotoneCubic profile = radiusProfile(anatomy, branch, inherited);
  const double spacing = kSampleSpacing * smallestRadius(branch);
  const int count = std::max(8, static_cast<int>(std::ceil(length / spacing)));
  const double start = chain.arc.empty() ? 0.0 : chain.arc.back();
  double u = u0;
  double along = 0.0;
  chain.first_sample.push_back(chain.points.empty() ? 0 : chain.points.size() - 1);
  for (int k = 0; k <= count; ++k)
  {
    if (k > 0)
    {
      const double next = u0 + (u1 - u0) * k / count;
      along += arcLength(spline, u, next);
      u = next;
      if (k == count)
        along = length;
    }
    if (k == 0 && !chain.points.empty())
      continue;
    double radius = profile(along / length);
    applyStenoses(branch, length, along, radius);
    chain.points.push_back(spline.position(u));
    chain.tangents.push_back(spline.derivative(u).normalized());
    chain.arc.push_back(start + along);
    chain.radii.push_back(radius);
  }
}

void requireGentleBends(const Anatomy& anatomy, const AnatomyChain& chain)
{
  for (std::size_t k = 1; k < chain.points.size(); ++k)
  {
    const double turn = (chain.tangents[k] - chain.tangents[k - 1]).norm();
    const double step = chain.arc[k] - chain.arc[k - 1];
    const double radius = std::max(chain.radii[k], chain.radii[k - 1]);
    if (turn * kTightestBend * radius <= step)
      continue;
    std::size_t part = chain.first_sample.size() - 1;
    while (part > 0 && chain.first_sample[part] >= k)
      --part;
    throw InputError(anatomy.file, "branches[" + branchAt(anatomy, chain.branches[part]).name + "].points",
                     "the radius of curvature is smaller than the lumen's radius near [" +
                         std::to_string(chain.points[k].x()) + ", " + std::to_string(chain.points[k].y()) + ", " +
                         std::to_string(chain.points[k].z()) + "] m; spread the points or reduce the diameter");
  }
}

AnatomyChain sampleChain(const Anatomy& anatomy, std::vector<int> branches, const std::vector<AnatomyChain>& earlier)
{
  AnatomyChain chain;
  chain.branches = std::move(branches);
  const AnatomyBranch& first = branchAt(anatomy, chain.branches.front());
  chain.parent = first.parent;
  chain.facets_around = first.facets_around;
  ControlPoints control = controlPoints(anatomy, chain);
  if (chain.parent >= 0)
  {
    for (const AnatomyChain& other : earlier)
      if (std::find(other.branches.begin(), other.branches.end(), chain.parent) != other.branches.end())
      {
        const NearestSample nearest = nearestOnBranch(other, chain.parent, control.points.front());
        if (nearest.distance > nearest.radius)
          throw InputError(anatomy.file, "branches[" + first.name + "].points",
                           "the first point must lie inside the parent \"" + branchAt(anatomy, chain.parent).name +
                               "\"; it is " + std::to_string(1e3 * nearest.distance) + " mm from its centreline");
        control.points.front() = nearest.point;
      }
  }
  const geometry::Spline3 spline(control.points);
  for (std::size_t part = 0; part < chain.branches.size(); ++part)
    sampleBranch(anatomy, branchAt(anatomy, chain.branches[part]), spline, spline.knots()[control.begin[part]],
                 spline.knots()[control.begin[part + 1]], chain);
  requireGentleBends(anatomy, chain);
  return chain;
}

}  // namespace

std::vector<AnatomyChain> sampleChains(const Anatomy& anatomy)
{
  std::vector<AnatomyChain> chains;
  for (std::size_t b = 0; b < anatomy.branches.size(); ++b)
  {
    if (anatomy.branches[b].continues)
      continue;
    std::vector<int> run{static_cast<int>(b)};
    for (std::size_t next = b + 1; next < anatomy.branches.size(); ++next)
      if (anatomy.branches[next].continues && anatomy.branches[next].parent == run.back())
        run.push_back(static_cast<int>(next));
    chains.push_back(sampleChain(anatomy, std::move(run), chains));
  }
  return chains;
}

CentrelineTree anatomyCentreline(const Anatomy& anatomy, const std::vector<AnatomyChain>& chains)
{
  CentrelineTree tree;
  tree.branches.resize(anatomy.branches.size());
  for (const AnatomyChain& chain : chains)
    for (std::size_t part = 0; part < chain.branches.size(); ++part)
    {
      const auto index = static_cast<std::size_t>(chain.branches[part]);
      CentrelineBranch& branch = tree.branches[index];
      branch.name = anatomy.branches[index].name;
      branch.parent = anatomy.branches[index].parent;
      const std::size_t end = part + 1 < chain.branches.size() ? chain.first_sample[part + 1] : chain.points.size() - 1;
      const auto from = static_cast<std::ptrdiff_t>(chain.first_sample[part]);
      const auto to = static_cast<std::ptrdiff_t>(end) + 1;
      branch.points.assign(chain.points.begin() + from, chain.points.begin() + to);
      branch.radii.assign(chain.radii.begin() + from, chain.radii.begin() + to);
    }
  return tree;
}

}  // namespace endovascular_sim::vessel
