#include "contrast/lumen/branch_line.h"

#include <string>

#include "common/error.h"

namespace endovascular_sim::contrast
{
namespace
{

const std::vector<Eigen::Vector3d>& checkedPoints(const vessel::CentrelineBranch& branch)
{
  double length = 0.0;
  for (std::size_t k = 1; k < branch.points.size(); ++k)
    length += (branch.points[k] - branch.points[k - 1]).norm();
  if (!(length > 0.0) || branch.radii.size() != branch.points.size())
    throw InputError("contrast", "centreline, branch \"" + branch.name + "\"",
                     "needs two or more points at different places, each with a radius");
  return branch.points;
}

}  // namespace

BranchLine::BranchLine(const vessel::CentrelineBranch& branch) : line_(checkedPoints(branch))
{
  std::size_t kept = 0;  // the polyline drops duplicates
  for (std::size_t k = 0; k < branch.points.size() && kept < line_.points().size(); ++k)
    if (branch.points[k] == line_.points()[kept])
    {
      radii_.push_back(branch.radii[k]);
      ++kept;
    }
}

CutPlane BranchLine::planeAt(double arc) const
{
  const double reach = 0.5 * radiusAt(arc);
  return {line_.at(arc), (line_.at(arc + reach) - line_.at(arc - reach)).normalized()};
}

}  // namespace endovascular_sim::contrast
