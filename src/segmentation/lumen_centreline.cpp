#include "segmentation/lumen_centreline.h"

#include <algorithm>
#include <utility>

#include <Eigen/LU>

namespace endovascular_sim::segmentation
{
namespace
{

constexpr double kSpacing = 1.0;          ///< of the points, in radii
constexpr double kShortest = 1e-3;        ///< least distance of two points [m]
constexpr double kBranchesAtAnEnd = 0.6;  ///< distance of a child from an end that it closes, in radii
constexpr double kContinues = 0.4;        ///< least radius of a child that continues its parent, in radii of the parent

/** Indices of the branches, parents first. */
std::vector<std::size_t> parentsFirst(const std::vector<LumenBranch>& branches)
{
  std::vector<std::size_t> order;
  std::vector<bool> placed(branches.size(), false);
  while (order.size() < branches.size())
  {
    const std::size_t before = order.size();
    for (std::size_t b = 0; b < branches.size(); ++b)
      if (!placed[b] && (branches[b].parent < 0 || placed[static_cast<std::size_t>(branches[b].parent)]))
      {
        placed[b] = true;
        order.push_back(b);
      }
    if (order.size() == before)  // no tree; impossible after joinBranches()
      break;
  }
  return order;
}

double inscribedRadius(const Section& section)
{
  return *std::min_element(section.radii.begin(), section.radii.end());
}

/** Centre of the parent that is nearest to the begin of a branch. */
Eigen::Vector3d beginOn(const LumenBranch& parent, const LumenBranch& branch)
{
  const Eigen::Vector3d& begin = branch.sections.front().centre;
  const auto nearest = std::min_element(parent.sections.begin(), parent.sections.end(),
                                        [&begin](const Section& a, const Section& b) {
                                          return (a.centre - begin).squaredNorm() < (b.centre - begin).squaredNorm();
                                        });
  return nearest->centre;
}

vessel::CentrelineBranch centrelineOf(const std::vector<LumenBranch>& branches, const LumenBranch& branch)
{
  vessel::CentrelineBranch result;
  result.name = branch.name;
  const auto add = [&result](const Eigen::Vector3d& p, double radius)
  {
    result.points.push_back(p);
    result.radii.push_back(radius);
  };
  const std::vector<Section>& sections = branch.sections;
  if (branch.parent >= 0)
    add(beginOn(branches[static_cast<std::size_t>(branch.parent)], branch), inscribedRadius(sections.front()));
  for (std::size_t k = 0; k < sections.size(); ++k)
  {
    const double radius = inscribedRadius(sections[k]);
    const Eigen::Vector3d& p = sections[k].centre;
    const bool is_last = k + 1 == sections.size();
    const double spacing = std::max(kShortest, kSpacing * radius);
    if (!result.points.empty() && !is_last && (p - result.points.back()).norm() < spacing)
      continue;
    if (is_last && result.points.size() > 2 && (p - result.points.back()).norm() < 0.5 * spacing)
    {
      result.points.pop_back();
      result.radii.pop_back();
    }
    add(p, radius);
  }
  const std::vector<Eigen::Vector3d> before = result.points;
  for (std::size_t k = 1; k + 1 < before.size(); ++k)
    result.points[k] = 0.5 * before[k] + 0.25 * (before[k - 1] + before[k + 1]);
  return result;
}

double medianRadius(const vessel::CentrelineBranch& branch)
{
  std::vector<double> radii = branch.radii;
  const auto middle = radii.begin() + static_cast<std::ptrdiff_t>(radii.size() / 2);
  std::nth_element(radii.begin(), middle, radii.end());
  return *middle;
}

/** True if children continue a branch at its end: they pass near the end and are about as wide. A narrow child near the
 * end, such as a coronary artery near the aortic valve, leaves the end open. */
bool isJunction(const vessel::CentrelineTree& tree, int branch, const Eigen::Vector3d& end, double radius)
{
  for (const vessel::CentrelineBranch& child : tree.branches)
  {
    if (child.parent != branch || medianRadius(child) < kContinues * radius)
      continue;
    for (std::size_t k = 0; k + 1 < child.points.size(); ++k)
    {
      const Eigen::Vector3d step = child.points[k + 1] - child.points[k];
      const double t = std::clamp((end - child.points[k]).dot(step) / std::max(1e-12, step.squaredNorm()), 0.0, 1.0);
      if ((child.points[k] + t * step - end).norm() < kBranchesAtAnEnd * radius)
        return true;
    }
  }
  return false;
}

}  // namespace

vessel::CentrelineTree lumenCentreline(const std::vector<LumenBranch>& branches)
{
  vessel::CentrelineTree tree;
  std::vector<int> number(branches.size(), -1);
  for (const std::size_t b : parentsFirst(branches))
  {
    vessel::CentrelineBranch branch = centrelineOf(branches, branches[b]);
    branch.parent = branches[b].parent < 0 ? -1 : number[static_cast<std::size_t>(branches[b].parent)];
    number[b] = static_cast<int>(tree.branches.size());
    tree.branches.push_back(std::move(branch));
  }
  return tree;
}

vessel::CentrelineTree toPatient(const Scan& scan, vessel::CentrelineTree tree)
{
  for (vessel::CentrelineBranch& branch : tree.branches)
    for (Eigen::Vector3d& p : branch.points)
      p = scan.toPatient(p);
  return tree;
}

geometry::TriangleMesh toPatient(const Scan& scan, geometry::TriangleMesh mesh)
{
  for (Eigen::Vector3d& p : mesh.vertices)
    p = scan.toPatient(p);
  if (scan.volume().grid.axes.determinant() < 0.0)  // mirrored: keep the normals outwards
    for (Eigen::Vector3i& t : mesh.triangles)
      std::swap(t[1], t[2]);
  return mesh;
}

std::vector<vessel::CentrelineEnd> openEnds(const vessel::CentrelineTree& tree)
{
  std::vector<vessel::CentrelineEnd> ends;
  for (std::size_t b = 0; b < tree.branches.size(); ++b)
  {
    const vessel::CentrelineBranch& branch = tree.branches[b];
    const std::size_t n = branch.points.size();
    const auto add = [&](std::size_t tip, std::size_t next)
    {
      if (!isJunction(tree, static_cast<int>(b), branch.points[tip], branch.radii[tip]))
        ends.push_back({static_cast<int>(b), branch.points[tip],
                        (branch.points[next] - branch.points[tip]).normalized(), branch.radii[tip]});
    };
    if (branch.parent < 0)
      add(0, 1);
    add(n - 1, n - 2);
  }
  return ends;
}

}  // namespace endovascular_sim::segmentation
