#include "vessel/centreline/centreline_extraction.h"

#include <algorithm>
#include <cmath>

#include <Eigen/Geometry>

#include "common/error.h"
#include "geometry/mesh_distance.h"
#include "vessel/centreline/medial_skeleton.h"
#include "vessel/centreline/medial_spheres.h"

namespace endovascular_sim::vessel
{
namespace
{

/** Minimum spacing of the thinned spheres, in radii: sparse enough for a graph, dense enough to overlap. */
constexpr double kSphereSpacing = 0.6;
/** Spacing of the centreline's points, in mean radii of the branch. */
constexpr double kPointSpacing = 0.35;
constexpr int kCentringRounds = 4;
/** Minimum decrease of the radius per length towards the rim of a flat cap. It is 1/√2 there, and smaller in a tapering
 *  vessel. */
constexpr double kRimSlope = 0.35;
/** Gap between the line's end and the cap, as a fraction of the extension. */
constexpr double kCapMargin = 0.05;

using Line = std::vector<Eigen::Vector3d>;

double lineLength(const Line& line)
{
  double length = 0.0;
  for (std::size_t k = 1; k < line.size(); ++k)
    length += (line[k] - line[k - 1]).norm();
  return length;
}

/** Resamples a line at equal arc lengths; the ends are retained. */
Line resample(const Line& line, double spacing)
{
  const double length = lineLength(line);
  const int count = std::max(1, static_cast<int>(std::lround(length / spacing)));
  Line out{line.front()};
  std::size_t k = 1;
  double passed = 0.0;
  for (int i = 1; i < count; ++i)
  {
    const double arc = length * i / count;
    while (k + 1 < line.size() && passed + (line[k] - line[k - 1]).norm() < arc)
    {
      passed += (line[k] - line[k - 1]).norm();
      ++k;
    }
    const double step = (line[k] - line[k - 1]).norm();
    const double fraction = step > 0.0 ? std::clamp((arc - passed) / step, 0.0, 1.0) : 0.0;
    out.emplace_back(line[k - 1] + fraction * (line[k] - line[k - 1]));
  }
  out.push_back(line.back());
  return out;
}

/** Local maximum of the distance to the wall in the plane normal to the line, by pattern search. */
Eigen::Vector3d centre(const Eigen::Vector3d& start, const Eigen::Vector3d& tangent,
                       const geometry::MeshDistance& distance)
{
  const Eigen::Vector3d u = tangent.unitOrthogonal();
  const Eigen::Vector3d v = tangent.cross(u);
  Eigen::Vector3d best = start;
  double best_distance = distance.closest(start).distance;
  const double first_step = 0.25 * best_distance;
  for (double step = first_step; step > 0.02 * first_step;)
  {
    bool improved = false;
    for (int k = 0; k < 6; ++k)
    {
      const double angle = k * M_PI / 3.0;
      const Eigen::Vector3d trial = best + step * (std::cos(angle) * u + std::sin(angle) * v);
      const double trial_distance = distance.closest(trial).distance;
      if (trial_distance <= best_distance || (trial - start).norm() > 2.0 * first_step)
        continue;
      best = trial;
      best_distance = trial_distance;
      improved = true;
      break;
    }
    if (!improved)
      step *= 0.5;
  }
  return best;
}

/** Moves a line onto the ridge of the distance to the wall and smooths it; the ends are retained. */
void centreLine(Line& line, const geometry::MeshDistance& distance)
{
  for (int round = 0; round < kCentringRounds; ++round)
  {
    Line centred = line;
    for (std::size_t k = 1; k + 1 < line.size(); ++k)
    {
      const Eigen::Vector3d chord = line[k + 1] - line[k - 1];
      if (chord.norm() > 0.0)
        centred[k] = centre(line[k], chord.normalized(), distance);
    }
    for (int sweep = 0; sweep < 3; ++sweep)
    {
      const Line rough = centred;
      for (std::size_t k = 1; k + 1 < line.size(); ++k)
        centred[k] = 0.25 * rough[k - 1] + 0.5 * rough[k] + 0.25 * rough[k + 1];
    }
    line = std::move(centred);
  }
}

/** Centreline extraction from medial spheres. */
class Extractor
{
public:
  Extractor(const geometry::TriangleMesh& mesh, const ProgressReport& progress) : distance_(mesh)
  {
    spheres_ = thinSpheres(medialSpheres(mesh, distance_, progress), kSphereSpacing);
    std::vector<std::vector<int>> neighbours = overlappingSpheres(spheres_);
    connectComponents(spheres_, distance_, neighbours);
    skeleton_ = medialSkeleton(spheres_, neighbours);
  }

  CentrelineTree run()
  {
    CentrelineTree tree;
    std::vector<bool> forks(skeleton_.size(), false);
    for (const SkeletonBranch& branch : skeleton_)
      if (branch.parent >= 0)
        forks[static_cast<std::size_t>(branch.parent)] = true;
    for (std::size_t b = 0; b < skeleton_.size(); ++b)
      tree.branches.push_back(lineOf(skeleton_[b], static_cast<int>(b), !forks[b]));
    closeLoops(tree, forks);
    return tree;
  }

private:
  CentrelineBranch lineOf(const SkeletonBranch& skeleton, int index, bool is_leaf) const
  {
    std::vector<int> spheres = skeleton.spheres;
    if (is_leaf)
      trimCapRim(spheres);
    if (skeleton.parent < 0)
    {
      std::reverse(spheres.begin(), spheres.end());
      trimCapRim(spheres);
      std::reverse(spheres.begin(), spheres.end());
    }
    Line line;
    double mean_radius = 0.0;
    for (int sphere : spheres)
    {
      line.push_back(at(sphere).centre);
      mean_radius += at(sphere).radius / static_cast<double>(spheres.size());
    }
    line = resample(line, kPointSpacing * mean_radius);
    centreLine(line, distance_);

    CentrelineBranch branch;
    branch.name = "branch_" + std::to_string(index);
    branch.parent = skeleton.parent;
    branch.points = line;
    for (const Eigen::Vector3d& point : line)
      branch.radii.push_back(distance_.closest(point).distance);
    if (is_leaf)
      extend(branch);
    if (skeleton.parent < 0)
    {
      std::reverse(branch.points.begin(), branch.points.end());
      std::reverse(branch.radii.begin(), branch.radii.end());
      extend(branch);
      std::reverse(branch.points.begin(), branch.points.end());
      std::reverse(branch.radii.begin(), branch.radii.end());
    }
    return branch;
  }

  const MedialSphere& at(int k) const { return spheres_[static_cast<std::size_t>(k)]; }

  /** Removes the last spheres of a branch that lie in the rim of a flat cap. */
  void trimCapRim(std::vector<int>& spheres) const
  {
    while (spheres.size() > 2)
    {
      const MedialSphere& tip = at(spheres.back());
      const MedialSphere& inner = at(spheres[spheres.size() - 2]);
      if (inner.radius - tip.radius < kRimSlope * (inner.centre - tip.centre).norm())
        break;
      spheres.pop_back();
    }
  }

  /** Extends a branch straight from its last point to the cap, with constant radius. */
  void extend(CentrelineBranch& branch) const
  {
    const Eigen::Vector3d tip = branch.points.back();
    const double radius = branch.radii.back();
    std::size_t k = branch.points.size() - 1;
    while (k > 0 && (branch.points[k] - tip).norm() < 1.5 * radius)
      --k;
    const Eigen::Vector3d direction = (tip - branch.points[k]).normalized();
    const double reach = (1.0 - kCapMargin) * distance_.rayHit(tip, direction);
    const int count = std::max(1, static_cast<int>(std::lround(reach / (kPointSpacing * radius))));
    for (int i = 1; i <= count && reach > 0.0; ++i)
    {
      branch.points.emplace_back(tip + reach * i / count * direction);
      branch.radii.push_back(radius);
    }
  }

  /** Connects tips that end inside another branch: a loop of the vessel was cut there. */
  static void closeLoops(CentrelineTree& tree, const std::vector<bool>& forks)
  {
    for (std::size_t b = 0; b < tree.branches.size(); ++b)
    {
      if (forks[b])
        continue;
      CentrelineBranch& branch = tree.branches[b];
      for (std::size_t other = 0; other < tree.branches.size(); ++other)
      {
        if (other == b)
          continue;
        const CentrelineBranch& near = tree.branches[other];
        for (std::size_t k = 0; k < near.points.size(); ++k)
          if ((near.points[k] - branch.points.back()).norm() < 0.6 * std::min(near.radii[k], branch.radii.back()) &&
              static_cast<int>(other) != branch.parent)
          {
            branch.points.push_back(near.points[k]);
            branch.radii.push_back(near.radii[k]);
            other = tree.branches.size() - 1;
            break;
          }
      }
    }
  }

  geometry::MeshDistance distance_;
  std::vector<MedialSphere> spheres_;
  std::vector<SkeletonBranch> skeleton_;
};

}  // namespace

CentrelineTree extractCentreline(const geometry::TriangleMesh& mesh, const ProgressReport& progress)
{
  reportProgress(progress, "centreline");
  CentrelineTree tree = Extractor(mesh, progress).run();
  if (tree.branches.empty())
    throw InputError("vessel", "centreline", "no lumen was found in the mesh; specify the entry as a pose");
  return tree;
}

}  // namespace endovascular_sim::vessel
