#include "segmentation/lumen_centreline.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include <Eigen/LU>

#include "geometry/spline.h"
#include "segmentation/gentle_bends.h"
#include "segmentation/surface/tube.h"

namespace endovascular_sim::segmentation
{
namespace
{

constexpr double kSpacing = 1.0;        ///< of the points, in radii
constexpr double kShortest = 1e-3;      ///< least distance of two points [m]
constexpr double kBeginSpacing = 0.25;  ///< of the points of a parent that are tried as the begin of a branch, in radii
constexpr double kNearestBegin = 0.3;   ///< least distance of the begin from the ostium, in radii
constexpr double kFarthestBegin = 4.0;  ///< largest one, beyond the distance of the parent's centreline, in radii
constexpr double kGentle = 1.5;         ///< ratio of bends (gentle_bends.h) beyond which the nearest begin is best
constexpr double kCostOfDistance = 0.1;   ///< ratio of bends that justifies a begin one radius farther away
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

/** First section of a branch outside of the lumens of its parent and the parent's parents. */
std::size_t ostiumOf(const std::vector<LumenBranch>& branches, const LumenBranch& branch)
{
  std::vector<Tube> lumens;
  for (int p = branch.parent; p >= 0; p = branches[static_cast<std::size_t>(p)].parent)
    lumens.emplace_back(branches[static_cast<std::size_t>(p)].sections, 1e-3);
  const std::size_t last = branch.sections.size() / 2;
  std::size_t k = 0;
  while (k < last && std::any_of(lumens.begin(), lumens.end(),
                                 [&](const Tube& lumen) { return lumen.at(branch.sections[k].centre).distance < 0.0; }))
    ++k;
  return k;
}

/** Centreline of the sections from one of them, with a point about every radius. */
vessel::CentrelineBranch centrelineFrom(const LumenBranch& branch, std::size_t first)
{
  vessel::CentrelineBranch result;
  result.name = branch.name;
  const std::vector<Section>& sections = branch.sections;
  for (std::size_t k = first; k < sections.size(); ++k)
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
    result.points.push_back(p);
    result.radii.push_back(radius);
  }
  const std::vector<Eigen::Vector3d> before = result.points;
  for (std::size_t k = 1; k + 1 < before.size(); ++k)
    result.points[k] = 0.5 * before[k] + 0.25 * (before[k - 1] + before[k + 1]);
  return result;
}

/** Lets a branch begin on the centreline of its parent: at the nearest point from which it reaches its ostium without a
 * tight bend. The path through the parent's lumen is not that of the images, where a wide branch would turn on the
 * spot. */
void beginOnParent(const vessel::CentrelineBranch& parent, vessel::CentrelineBranch& branch)
{
  const geometry::Spline3 spline(parent.points);
  const double length = spline.knots().back();
  const double radius = branch.radii.front();
  const Eigen::Vector3d ostium = branch.points.front();
  double least = 1e30;  // distance from the ostium
  const int count = std::max(1, static_cast<int>(std::ceil(length / (kBeginSpacing * radius))));
  for (int k = 0; k <= count; ++k)
    least = std::min(least, (spline.position(length * k / count) - ostium).norm());
  // The beginning of the branch up to some radii, whose bends depend on the first point.
  const std::size_t beginning = std::min<std::size_t>(branch.points.size(), 6);
  vessel::CentrelineBranch stem;
  stem.points.assign(branch.points.begin(), branch.points.begin() + static_cast<std::ptrdiff_t>(beginning));
  stem.radii.assign(branch.radii.begin(), branch.radii.begin() + static_cast<std::ptrdiff_t>(beginning));
  stem.points.insert(stem.points.begin(), Eigen::Vector3d::Zero());
  stem.radii.insert(stem.radii.begin(), radius);
  double best = -1e30;
  Eigen::Vector3d begin = ostium;
  for (int k = 0; k <= count; ++k)
  {
    stem.points.front() = spline.position(length * k / count);
    const double distance = (stem.points.front() - ostium).norm();
    if (distance > least + kFarthestBegin * radius || distance < kNearestBegin * radius)
      continue;
    const double merit = std::min(bendRatio(stem), kGentle) - kCostOfDistance * (distance - least) / radius;
    if (merit > best)
    {
      best = merit;
      begin = stem.points.front();
    }
  }
  if (begin == ostium)  // the ostium lies on the parent's centreline
    return;
  branch.points.insert(branch.points.begin(), begin);
  branch.radii.insert(branch.radii.begin(), radius);
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
    vessel::CentrelineBranch branch = centrelineFrom(branches[b], ostiumOf(branches, branches[b]));
    branch.parent = branches[b].parent < 0 ? -1 : number[static_cast<std::size_t>(branches[b].parent)];
    if (branch.parent >= 0)
      beginOnParent(tree.branches[static_cast<std::size_t>(branch.parent)], branch);
    makeBendsGentle(branch);
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
