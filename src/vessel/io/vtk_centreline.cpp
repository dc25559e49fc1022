#include "vessel/io/vtk_centreline.h"

#include <algorithm>
#include <limits>

#include "common/error.h"
#include "vessel/io/mesh_builder.h"

namespace endovascular_sim::vessel
{
namespace
{

constexpr double kSpacing = 0.2;   // least distance of the points of a line, in radii
constexpr double kShared = 0.25;   // distance to an earlier line within which points are shared, in radii
constexpr double kEarlier = 0.1;   // advantage of earlier branches, which fork later ones, in radii
constexpr double kShortest = 0.5;  // length of a branch, in radii of its parent
constexpr std::size_t kMostLines = 500;
constexpr std::size_t kMostPoints = 20000;  // of all lines after thinning: the time is quadratic in it

/** Line of the file [m]. */
struct Line
{
  std::vector<Eigen::Vector3d> points;
  std::vector<double> radii;

  void reverse()
  {
    std::reverse(points.begin(), points.end());
    std::reverse(radii.begin(), radii.end());
  }
};

/** Nearest place on the branches of a tree. */
struct Foot
{
  int branch = -1;
  Eigen::Vector3d point = Eigen::Vector3d::Zero();
  double radius = 0.0;
  double distance = std::numeric_limits<double>::infinity();
};

Foot footOn(const CentrelineTree& tree, const Eigen::Vector3d& p)
{
  Foot foot;
  for (std::size_t b = 0; b < tree.branches.size(); ++b)
  {
    const CentrelineBranch& branch = tree.branches[b];
    for (std::size_t k = 0; k + 1 < branch.points.size(); ++k)
    {
      const Eigen::Vector3d segment = branch.points[k + 1] - branch.points[k];
      const double t = std::clamp(segment.dot(p - branch.points[k]) / segment.squaredNorm(), 0.0, 1.0);
      const Eigen::Vector3d point = branch.points[k] + t * segment;
      const double distance = (point - p).norm();
      const bool is_other = foot.branch >= 0 && foot.branch != static_cast<int>(b);
      if (distance + (is_other ? kEarlier * branch.radii[k] : 0.0) >= foot.distance)
        continue;
      foot = {static_cast<int>(b), point, branch.radii[k] + t * (branch.radii[k + 1] - branch.radii[k]), distance};
    }
  }
  return foot;
}

/** Lines with points at least kSpacing radii apart; the ends are kept. */
class LineReader
{
public:
  LineReader(const VtkPolyData& data, double unit, const geometry::MeshDistance& distance, const std::string& path)
    : data_(data), unit_(unit), sign_(namesRasSpace(data.space) ? -1.0 : 1.0), distance_(distance), path_(path)
  {
  }

  std::vector<Line> read()
  {
    if (data_.lines.size() > kMostLines)
      throw InputError(path_, "",
                       "has " + std::to_string(data_.lines.size()) + " lines; a centreline has at most " +
                           std::to_string(kMostLines) + ", each from one end or fork to another");
    std::vector<Line> lines;
    std::size_t points = 0;
    for (std::size_t k = 0; k < data_.lines.size(); ++k)
    {
      Line line = thinned(k);
      points += line.points.size();
      if (points > kMostPoints)
        refuse(k, "brings more than " + std::to_string(kMostPoints) + " points; resample the centreline");
      if (line.points.size() > 1)
        lines.push_back(std::move(line));
    }
    if (lines.empty())
      throw InputError(path_, "", "has no lines; give the centreline, not the surface");
    return lines;
  }

private:
  [[noreturn]] void refuse(std::size_t line, const std::string& reason) const
  {
    throw InputError(path_, "line " + std::to_string(line), reason);
  }

  Eigen::Vector3d pointOf(std::size_t line, long long index) const
  {
    if (index < 0 || static_cast<std::size_t>(index) >= data_.points.size())
      refuse(line, "names point " + std::to_string(index) + ", but the file has " +
                       std::to_string(data_.points.size()) + " (from 0); the file is damaged");
    const Eigen::Vector3d& p = data_.points[static_cast<std::size_t>(index)];
    Eigen::Vector3d metres = unit_ * Eigen::Vector3d(sign_ * p.x(), sign_ * p.y(), p.z());
    if (!(metres.cwiseAbs().maxCoeff() < 1e6))
      refuse(line, "has a coordinate that is no number of a vessel; check vessel.unit");
    return metres;
  }

  double radiusOf(const Eigen::Vector3d& point, long long index) const
  {
    const double radius = data_.radii.empty() ? 0.0 : unit_ * data_.radii[static_cast<std::size_t>(index)];
    return radius > 0.0 && radius < 1.0 ? radius : distance_.closest(point).distance;
  }

  Line thinned(std::size_t k) const
  {
    const std::vector<long long> cell = data_.lines.cell(k);
    Line line;
    for (std::size_t i = 0; i < cell.size(); ++i)
    {
      const Eigen::Vector3d point = pointOf(k, cell[i]);
      const bool is_first = line.points.empty();
      const double step = is_first ? 0.0 : (point - line.points.back()).norm();
      const double least = is_first ? 0.0 : std::max(kSpacing * line.radii.back(), 1e-6);
      if (!is_first && step < least && (i + 1 < cell.size() || step <= 1e-6))
        continue;
      line.points.push_back(point);
      line.radii.push_back(radiusOf(point, cell[i]));
    }
    return line;
  }

  const VtkPolyData& data_;
  double unit_;
  double sign_;  ///< of x and y
  const geometry::MeshDistance& distance_;
  const std::string& path_;
};

bool isNear(const Line& line, const Eigen::Vector3d& p, double distance)
{
  return std::any_of(line.points.begin(), line.points.end(),
                     [&](const Eigen::Vector3d& q) { return (q - p).norm() <= distance; });
}

/** Moves the root to the front of the lines, with the root's end first. */
void beginWithRoot(std::vector<Line>& lines)
{
  const Line& first = lines.front();
  const bool is_common = std::all_of(
      lines.begin(), lines.end(),
      [&](const Line& line) { return (line.points.front() - first.points.front()).norm() <= first.radii.front(); });
  if (is_common)
    return;
  std::size_t root = 0;
  bool reversed = false;
  double widest = 0.0;
  for (std::size_t k = 0; k < lines.size(); ++k)
    for (const bool at_back : {false, true})
    {
      const Eigen::Vector3d& end = at_back ? lines[k].points.back() : lines[k].points.front();
      const double radius = at_back ? lines[k].radii.back() : lines[k].radii.front();
      bool is_free = radius > widest;
      for (std::size_t other = 0; is_free && other < lines.size(); ++other)
        is_free = other == k || !isNear(lines[other], end, radius);
      if (!is_free)
        continue;
      widest = radius;
      root = k;
      reversed = at_back;
    }
  std::rotate(lines.begin(), lines.begin() + static_cast<std::ptrdiff_t>(root),
              lines.begin() + static_cast<std::ptrdiff_t>(root) + 1);
  if (reversed)
    lines.front().reverse();
}

/** Adds what a line, whose first point is near the tree, does not share with it. */
void addBranch(CentrelineTree& tree, const Line& line)
{
  CentrelineBranch branch;
  Foot last = footOn(tree, line.points.front());
  std::size_t k = 1;
  for (; k < line.points.size(); ++k)
  {
    const Foot foot = footOn(tree, line.points[k]);
    if (foot.distance > kShared * std::max(foot.radius, line.radii[k]))
      break;
    last = foot;
  }
  branch.name = "branch_" + std::to_string(tree.branches.size());
  branch.parent = last.branch;
  branch.points.push_back(last.point);
  branch.radii.push_back(last.radius);
  double length = 0.0;
  for (; k < line.points.size(); ++k)
  {
    const double step = (line.points[k] - branch.points.back()).norm();
    if (step <= 1e-6)
      continue;
    length += step;
    branch.points.push_back(line.points[k]);
    branch.radii.push_back(line.radii[k]);
  }
  if (branch.points.size() > 1 && length > kShortest * last.radius)
    tree.branches.push_back(std::move(branch));
}

bool meets(const CentrelineTree& tree, const Eigen::Vector3d& end, double radius)
{
  const Foot foot = footOn(tree, end);
  return foot.distance <= std::max(foot.radius, radius);
}

}  // namespace

CentrelineTree vtkCentreline(const VtkPolyData& data, double unit, const geometry::MeshDistance& distance,
                             const std::string& path)
{
  std::vector<Line> lines = LineReader(data, unit, distance, path).read();
  beginWithRoot(lines);
  CentrelineTree tree;
  tree.branches.push_back({"branch_0", -1, lines.front().points, lines.front().radii});
  lines.erase(lines.begin());
  while (!lines.empty())
  {
    const std::size_t before = lines.size();
    for (auto line = lines.begin(); line != lines.end();)
    {
      const bool at_front = meets(tree, line->points.front(), line->radii.front());
      if (!at_front && !meets(tree, line->points.back(), line->radii.back()))
      {
        ++line;
        continue;
      }
      if (!at_front)
        line->reverse();
      addBranch(tree, *line);
      line = lines.erase(line);
    }
    if (lines.size() == before)
      throw InputError(path, "",
                       "has " + std::to_string(lines.size()) +
                           " lines that do not meet the others; give the centreline of one connected vessel");
  }
  return tree;
}

}  // namespace endovascular_sim::vessel
