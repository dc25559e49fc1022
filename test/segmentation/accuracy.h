#pragma once

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "image/volume.h"
#include "phantom/phantom.h"
#include "phantom/true_clicks.h"
#include "segmentation/segment_vessel.h"
#include "segmentation/surface/tube.h"
#include "vessel/anatomy/implicit_vessel.h"

namespace endovascular_sim::segmentation
{

/** Errors of the diameter in a range of true diameters. */
struct DiameterErrors
{
  double bias = 0.0;  ///< [m]
  double rms = 0.0;   ///< [m]
  int sections = 0;

  void add(double error)
  {
    bias += error;
    rms += error * error;
    ++sections;
  }
  void finish()
  {
    bias /= std::max(1, sections);
    rms = std::sqrt(rms / std::max(1, sections));
  }
};

/** Differences of a segmented branch from the truth, without its ends and the surroundings of other vessels. */
struct Accuracy
{
  double dice = 0.0;
  double mean = 0.0;          ///< distance from the contours to the true wall [m]
  double p95 = 0.0;           ///< its 95th percentile [m]
  double back = 0.0;          ///< 95th percentile of the distance from the true wall to the contours [m]
  double volume_ratio = 0.0;  ///< segmented over true volume
  DiameterErrors small;       ///< true diameters of 2 to 3 mm
  DiameterErrors medium;      ///< 3 to 4 mm
  double throat_error = 0.0;  ///< error of the least diameter [m]
  double throat_shift = 0.0;  ///< distance of the segmented throat from the true one [m]
};

/** Exact geometry of an anatomy. */
class Truth
{
public:
  explicit Truth(const std::string& name = "plain")
    : anatomy(vessel::readAnatomy(std::string(PROJECT_DIR) + "/config/anatomies/" + name + ".yaml")),
      chains(vessel::sampleChains(anatomy)),
      field(anatomy, chains)
  {
  }

  /** Chain that begins with a branch. */
  const vessel::AnatomyChain& chain(const std::string& name) const
  {
    return *std::find_if(chains.begin(), chains.end(),
                         [&](const vessel::AnatomyChain& c)
                         { return anatomy.branches[static_cast<std::size_t>(c.branches.front())].name == name; });
  }

  /** True if a sample of a chain is far from all other chains. */
  bool isAlone(const vessel::AnatomyChain& own, std::size_t k) const
  {
    for (const vessel::AnatomyChain& other : chains)
    {
      if (&other == &own)
        continue;
      for (std::size_t q = 0; q < other.points.size(); ++q)
        if ((other.points[q] - own.points[k]).norm() < 2.0 * own.radii[k] + 1.5 * other.radii[q])
          return false;
    }
    return true;
  }

  vessel::Anatomy anatomy;
  std::vector<vessel::AnatomyChain> chains;
  vessel::ImplicitVessel field;
};

/** Part of the heart of the default anatomy as a CT angiogram. */
inline image::Volume heartScan(const Truth& truth, const phantom::PhantomSettings& noise = {},
                               const Eigen::Vector3d& low = {-0.048, -0.1, 0.092},
                               const Eigen::Vector3d& high = {0.09, 0.046, 0.228})
{
  phantom::PhantomSettings settings = noise;
  settings.grid = phantom::gridOfBox(low, high, Eigen::Vector3d::Constant(4.5e-4));
  return phantom::makePhantom(truth.anatomy, settings);
}

/** Two simulated clicks per branch. */
inline ClickSet clicksInto(const Truth& truth, const std::vector<std::string>& names, const image::VolumeGrid& grid,
                           std::uint64_t seed)
{
  ClickSet set;
  set.file = "clicks";
  for (const phantom::BranchClicks& branch : phantom::trueClicks(truth.anatomy, names, grid.bounds(), seed))
  {
    BranchClicks clicks;
    clicks.name = branch.name;
    for (const Eigen::Vector3d& p : branch.points)
      clicks.clicks.push_back({p, "simulated"});
    set.branches.push_back(clicks);
  }
  return set;
}

/** Compares a branch with the truth, in true cross-sections every 0.5 mm. */
inline Accuracy accuracyOf(const Truth& truth, const Scan& scan, const LumenBranch& branch)
{
  const vessel::AnatomyChain& chain = truth.chain(branch.name);
  const Tube tube(branch.sections, 1.5e-3);
  Accuracy result;
  double both = 0.0;
  double own = 0.0;
  double real = 0.0;
  std::vector<double> back;
  double narrowest = 1e30;
  double least = 1e30;
  Eigen::Vector3d throat = Eigen::Vector3d::Zero();
  Eigen::Vector3d found = Eigen::Vector3d::Zero();
  std::vector<bool> covered(chain.points.size(), false);
  double next = 0.0;
  for (std::size_t k = 0; k < chain.points.size(); ++k)
  {
    const Eigen::Vector3d p = scan.toGrid(chain.points[k]);
    const double from_begin = (p - branch.sections.front().centre).norm();
    const double from_end = (p - branch.sections.back().centre).norm();
    covered[k] =
        truth.isAlone(chain, k) && tube.at(p).distance < 0.0 && std::min(from_begin, from_end) > 1.5 * chain.radii[k];
    if (!covered[k] || chain.arc[k] < next)
      continue;
    next = chain.arc[k] + 5e-4;
    const Eigen::Vector3d t = chain.tangents[k];
    const Eigen::Vector3d u = t.unitOrthogonal();
    const Eigen::Vector3d w = t.cross(u);
    const double half = 1.5 * chain.radii[k] + 5e-4;
    for (double x = -half; x <= half; x += 1.5e-4)
      for (double y = -half; y <= half; y += 1.5e-4)
      {
        const Eigen::Vector3d q = chain.points[k] + x * u + y * w;
        const bool in_truth = truth.field.at(q).distance < 0.0;
        const bool in_tube = tube.at(scan.toGrid(q)).distance < 0.0;
        both += in_truth && in_tube ? 1.0 : 0.0;
        own += in_tube ? 1.0 : 0.0;
        real += in_truth ? 1.0 : 0.0;
      }
    for (int n = 0; n < 24; ++n)
    {
      const double angle = n * M_PI / 12.0;
      const Eigen::Vector3d wall = chain.points[k] + chain.radii[k] * (std::cos(angle) * u + std::sin(angle) * w);
      back.push_back(std::abs(tube.at(scan.toGrid(wall)).distance));
    }
  }
  std::vector<double> distances;
  for (const Section& section : branch.sections)
  {
    const Eigen::Vector3d centre = scan.toPatient(section.centre);
    std::size_t nearest = 0;
    for (std::size_t k = 0; k < chain.points.size(); ++k)
      if ((chain.points[k] - centre).squaredNorm() < (chain.points[nearest] - centre).squaredNorm())
        nearest = k;
    if (!covered[nearest])
      continue;
    for (int ray = 0; ray < kRays; ++ray)
    {
      const Eigen::Vector3d wall =
          section.centre + section.radii[static_cast<std::size_t>(ray)] * section.direction(ray);
      distances.push_back(std::abs(truth.field.at(scan.toPatient(wall)).distance));
    }
    const double diameter = 2.0 * chain.radii[nearest];
    const double error = section.diameter() - diameter;
    if (diameter >= 2e-3 && diameter < 3e-3)
      result.small.add(error);
    else if (diameter >= 3e-3 && diameter < 4e-3)
      result.medium.add(error);
    if (diameter < narrowest && nearest < chain.points.size() / 2)
    {
      narrowest = diameter;
      throat = chain.points[nearest];
    }
    if (section.diameter() < least && nearest < chain.points.size() / 2)
    {
      least = section.diameter();
      found = centre;
    }
  }
  std::sort(distances.begin(), distances.end());
  std::sort(back.begin(), back.end());
  for (const double d : distances)
    result.mean += d / static_cast<double>(distances.size());
  if (!distances.empty())
    result.p95 = distances[distances.size() * 95 / 100];
  if (!back.empty())
    result.back = back[back.size() * 95 / 100];
  result.dice = 2.0 * both / (own + real);
  result.volume_ratio = own / real;
  result.small.finish();
  result.medium.finish();
  result.throat_error = least - narrowest;
  result.throat_shift = (found - throat).norm();
  return result;
}

}  // namespace endovascular_sim::segmentation
