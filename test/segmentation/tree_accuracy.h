#pragma once

#include <algorithm>
#include <map>
#include <string>
#include <vector>

#include "geometry/mesh_distance.h"
#include "segmentation/lumen_centreline.h"
#include "test/segmentation/accuracy.h"

namespace endovascular_sim::segmentation
{

/** Distances between two surfaces in a region. */
struct SurfaceDistances
{
  double mean = 0.0;     ///< [m]
  double p95 = 0.0;      ///< [m]
  double largest = 0.0;  ///< [m]
  std::size_t points = 0;

  SurfaceDistances() = default;
  explicit SurfaceDistances(std::vector<double> distances) : points(distances.size())
  {
    if (distances.empty())
      return;
    std::sort(distances.begin(), distances.end());
    for (const double d : distances)
      mean += d / static_cast<double>(distances.size());
    p95 = distances[distances.size() * 95 / 100];
    largest = distances.back();
  }
};

/** Distances of the united surface from the exact one, and back. */
struct TreeAccuracy
{
  std::map<std::string, SurfaceDistances> there;  ///< from the segmented surface to the true one, per region
  std::map<std::string, SurfaceDistances> back;   ///< from the true surface to the segmented one
  double aorta_dice = 0.0;                        ///< of the lumen within 1.6 radii of the aorta's axis
};

/** Compares the surface of joined branches with the exact one. A region has the name of a branch; where two lumens are
 * nearer than the smaller diameter, i.e. with the rounding of the ostium, it has the names of both. Points within 2 mm
 * of the plane of a flat end do not count. */
class TreeComparison
{
public:
  TreeComparison(const Truth& truth, const Scan& scan, const std::vector<LumenBranch>& branches,
                 const geometry::TriangleMesh& surface)
    : truth_(truth), scan_(scan), branches_(branches), surface_(surface)
  {
    for (const LumenBranch& branch : branches)
      tubes_.emplace_back(branch.sections, 3e-3);
    for (const vessel::CentrelineEnd& end : openEnds(lumenCentreline(branches)))
      ends_.push_back({scan.toPatient(end.position), scan.volume().grid.axes * end.inward, end.radius});
    for (const vessel::AnatomyChain& chain : truth.chains)
      if (std::any_of(branches.begin(), branches.end(),
                      [&](const LumenBranch& branch) { return branch.name == nameOf(chain); }))
        chains_.push_back(&chain);
  }

  TreeAccuracy run() const
  {
    TreeAccuracy result;
    result.there = there();
    result.back = back();
    result.aorta_dice = diceOfTheAorta();
    return result;
  }

private:
  static constexpr double kLid = 2e-3;   ///< distance from the plane of a flat end [m]
  static constexpr double kDeep = 5e-3;  ///< depth in another lumen at which a tube has no wall any more [m]

  struct End
  {
    Eigen::Vector3d position;
    Eigen::Vector3d inward;
    double radius;
  };

  std::string nameOf(const vessel::AnatomyChain& chain) const
  {
    return truth_.anatomy.branches[static_cast<std::size_t>(chain.branches.front())].name;
  }

  /** Least distance of a point from the lumen of a chain [m], and the radius there. The bulges of the anatomy, sinuses
   * of the aortic root, belong to its first chain. */
  std::pair<double, double> fromLumen(const vessel::AnatomyChain& chain, const Eigen::Vector3d& p) const
  {
    std::pair<double, double> least(1e30, 0.0);
    for (const vessel::Bulge& bulge : truth_.anatomy.bulges)
      if (const double d = (bulge.centre - p).norm() - bulge.radius;
          &chain == &truth_.chains.front() && d < least.first)
        least = {d, bulge.radius};
    for (std::size_t k = 0; k < chain.points.size(); ++k)
      if (const double d = (chain.points[k] - p).norm() - chain.radii[k]; d < least.first)
        least = {d, chain.radii[k]};
    return least;
  }

  /** Region of a point on one of the surfaces; empty near a flat end and beside chains without clicks. */
  std::string regionOf(const Eigen::Vector3d& p) const
  {
    for (const End& end : ends_)
      if ((p - end.position).norm() < 1.5 * end.radius && std::abs((p - end.position).dot(end.inward)) < kLid)
        return "";
    std::vector<std::pair<std::pair<double, double>, std::string>> near;
    for (const vessel::AnatomyChain& chain : truth_.chains)
      near.emplace_back(fromLumen(chain, p), nameOf(chain));
    std::sort(near.begin(), near.end());
    const auto isClicked = [this](const std::string& name)
    {
      return std::any_of(chains_.begin(), chains_.end(),
                         [&](const vessel::AnatomyChain* chain) { return nameOf(*chain) == name; });
    };
    const auto& [first, second] = std::pair(near[0], near[1]);
    if (!isClicked(first.second))
      return "";
    if (second.first.first > 2.0 * std::min(first.first.second, second.first.second))
      return first.second;
    return isClicked(second.second)
               ? std::min(first.second, second.second) + " + " + std::max(first.second, second.second)
               : "";
  }

  /** Foot point on the true wall, by the slope of the implicit function. */
  Eigen::Vector3d footOnTruth(const Eigen::Vector3d& p) const
  {
    Eigen::Vector3d foot = p;
    for (int round = 0; round < 3; ++round)
    {
      const vessel::FieldSample sample = truth_.field.at(foot);
      foot -= sample.distance * sample.gradient / std::max(0.25, sample.gradient.squaredNorm());
    }
    return foot;
  }

  std::map<std::string, SurfaceDistances> there() const
  {
    std::map<std::string, std::vector<double>> distances;
    for (const Eigen::Vector3d& vertex : surface_.vertices)
      if (const std::string region = regionOf(scan_.toPatient(vertex)); !region.empty())
        distances[region].push_back((footOnTruth(scan_.toPatient(vertex)) - scan_.toPatient(vertex)).norm());
    return {distances.begin(), distances.end()};
  }

  /** From points of the true tubes, moved onto the surface of their union. Points deep in another lumen do not count.
   */
  std::map<std::string, SurfaceDistances> back() const
  {
    const geometry::MeshDistance mesh(surface_);
    std::map<std::string, std::vector<double>> distances;
    for (const vessel::AnatomyChain* chain : chains_)
      for (std::size_t k = 0; k < chain->points.size(); ++k)
      {
        const Eigen::Vector3d u = chain->tangents[k].unitOrthogonal();
        const Eigen::Vector3d w = chain->tangents[k].cross(u);
        for (int n = 0; n < 24; ++n)
        {
          const double angle = n * M_PI / 12.0;
          const Eigen::Vector3d point =
              chain->points[k] + chain->radii[k] * (std::cos(angle) * u + std::sin(angle) * w);
          const Eigen::Vector3d wall = footOnTruth(point);
          if ((wall - point).norm() > kDeep || std::abs(truth_.field.at(wall).distance) > 5e-5 || !isBetweenEnds(wall))
            continue;
          if (const std::string region = regionOf(wall); !region.empty())
            distances[region].push_back(mesh.closest(scan_.toGrid(wall)).distance);
        }
      }
    return {distances.begin(), distances.end()};
  }

  /** True beside a section of the segmentation. */
  bool isBetweenEnds(const Eigen::Vector3d& p) const
  {
    const Eigen::Vector3d q = scan_.toGrid(p);
    return std::any_of(tubes_.begin(), tubes_.end(), [&q](const Tube& tube) { return tube.at(q).distance < 2e-3; });
  }

  double diceOfTheAorta() const
  {
    const LumenBranch& aorta = *std::find_if(
        branches_.begin(), branches_.end(), [](const LumenBranch& branch) { return branch.name == "ascending_aorta"; });
    double both = 0.0;
    double own = 0.0;
    double real = 0.0;
    const std::vector<double> arc = aorta.arc();
    double next = kLid;
    for (std::size_t k = 0; k < arc.size(); ++k)
    {
      if (arc[k] < next || arc.back() - arc[k] < kLid)
        continue;
      next = arc[k] + 5e-4;
      const Section& section = aorta.sections[k];
      const double reach = 0.8 * section.diameter();
      for (double x = -reach; x <= reach; x += 3e-4)
        for (double y = -reach; y <= reach; y += 3e-4)
        {
          const Eigen::Vector3d q = section.centre + x * section.u + y * section.w;
          const bool in_truth = truth_.field.at(scan_.toPatient(q)).distance < 0.0;
          const bool in_own =
              std::any_of(tubes_.begin(), tubes_.end(), [&q](const Tube& tube) { return tube.at(q).distance < 0.0; });
          both += in_truth && in_own ? 1.0 : 0.0;
          own += in_own ? 1.0 : 0.0;
          real += in_truth ? 1.0 : 0.0;
        }
    }
    return 2.0 * both / (own + real);
  }

  const Truth& truth_;
  const Scan& scan_;
  const std::vector<LumenBranch>& branches_;
  const geometry::TriangleMesh& surface_;
  std::vector<Tube> tubes_;
  std::vector<End> ends_;
  std::vector<const vessel::AnatomyChain*> chains_;
};

}  // namespace endovascular_sim::segmentation
