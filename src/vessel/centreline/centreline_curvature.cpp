#include "vessel/centreline/centreline_curvature.h"

#include <limits>

#include <Eigen/Geometry>

namespace endovascular_sim::vessel
{
namespace
{

constexpr double kSpacing = 0.25;  // minimum spacing of evaluated points, in radii of the lumen

/** Menger curvature: curvature of the circle through three points [1/m]. */
double circleCurvature(const Eigen::Vector3d& a, const Eigen::Vector3d& b, const Eigen::Vector3d& c)
{
  const double sides = (b - a).norm() * (c - b).norm() * (c - a).norm();
  return sides > 0.0 ? 2.0 * (b - a).cross(c - b).norm() / sides : 0.0;
}

}  // namespace

CentrelineCurvature::CentrelineCurvature(const CentrelineTree& tree)
{
  for (const CentrelineBranch& branch : tree.branches)
    addBranch(branch);
}

void CentrelineCurvature::addBranch(const CentrelineBranch& branch)
{
  const std::vector<Eigen::Vector3d>& x = branch.points;
  std::size_t kept = 0;
  for (std::size_t i = 0; i < x.size(); ++i)
  {
    if (i > 0 && i + 1 < x.size() && (x[i] - x[kept]).norm() < kSpacing * branch.radii[i])
      continue;
    kept = i;
    std::size_t before = i;
    std::size_t after = i;
    while (before > 0 && (x[i] - x[before]).norm() < branch.radii[i])
      --before;
    while (after + 1 < x.size() && (x[after] - x[i]).norm() < branch.radii[i])
      ++after;
    points_.push_back(x[i]);
    curvature_.push_back(circleCurvature(x[before], x[i], x[after]));
  }
}

double CentrelineCurvature::at(const Eigen::Vector3d& point) const
{
  double nearest = std::numeric_limits<double>::infinity();
  double curvature = 0.0;
  for (std::size_t i = 0; i < points_.size(); ++i)
  {
    const double distance = (points_[i] - point).squaredNorm();
    if (distance < nearest)
    {
      nearest = distance;
      curvature = curvature_[i];
    }
  }
  return curvature;
}

}  // namespace endovascular_sim::vessel
