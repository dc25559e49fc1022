#include "flow/body/vessel_flow_tree.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <string>

#include "common/error.h"

namespace endovascular_sim::flow
{
namespace
{

constexpr double kPi = 3.14159265358979323846;
constexpr double kShortestCell = 2e-3;  // [m]
constexpr double kSampling = 5e-4;      // of the radii within a cell [m]
constexpr double kFlatProfile = 6e-3;   // radius above which the velocity profile is nearly flat [m]
constexpr double kCap = 2.0;            // length of a trunk beyond its last branch that is no outlet, in radii
constexpr double kLongestOffset = 0.5;  // of a branch's beginning in its parent, relative to its length

/** Branch with arc lengths, and the place where it begins on its parent. */
struct MeasuredBranch
{
  std::vector<double> arcs;  // of the points [m]
  double on_parent = 0.0;    // arc length of its first point on the parent [m]
  double begin = 0.0;        // arc length at which it leaves the parent's lumen [m]
  std::vector<int> children;

  double length() const { return arcs.back(); }
};

double radiusAt(const vessel::CentrelineBranch& branch, const MeasuredBranch& measured, double arc)
{
  const auto after = std::upper_bound(measured.arcs.begin(), measured.arcs.end(), arc);
  const std::size_t k =
      std::clamp<std::size_t>(static_cast<std::size_t>(after - measured.arcs.begin()), 1, measured.arcs.size() - 1);
  const double step = measured.arcs[k] - measured.arcs[k - 1];
  const double share = step > 0.0 ? std::clamp((arc - measured.arcs[k - 1]) / step, 0.0, 1.0) : 0.0;
  return branch.radii[k - 1] + share * (branch.radii[k] - branch.radii[k - 1]);
}

/** Arc length of the point of a branch that is nearest to a point [m]. */
double nearestArc(const vessel::CentrelineBranch& branch, const MeasuredBranch& measured, const Eigen::Vector3d& point)
{
  double arc = 0.0, nearest = std::numeric_limits<double>::infinity();
  for (std::size_t k = 1; k < branch.points.size(); ++k)
  {
    const Eigen::Vector3d step = branch.points[k] - branch.points[k - 1];
    const double length = step.squaredNorm();
    const double share = length > 0.0 ? std::clamp((point - branch.points[k - 1]).dot(step) / length, 0.0, 1.0) : 0.0;
    const double distance = (branch.points[k - 1] + share * step - point).squaredNorm();
    if (distance >= nearest)
      continue;
    nearest = distance;
    arc = measured.arcs[k - 1] + share * (measured.arcs[k] - measured.arcs[k - 1]);
  }
  return arc;
}

std::vector<MeasuredBranch> measure(const vessel::CentrelineTree& tree)
{
  std::vector<MeasuredBranch> measured(tree.branches.size());
  for (std::size_t b = 0; b < tree.branches.size(); ++b)
  {
    const vessel::CentrelineBranch& branch = tree.branches[b];
    measured[b].arcs.assign(branch.points.size(), 0.0);
    for (std::size_t k = 1; k < branch.points.size(); ++k)
      measured[b].arcs[k] = measured[b].arcs[k - 1] + (branch.points[k] - branch.points[k - 1]).norm();
  }
  for (std::size_t b = 0; b < tree.branches.size(); ++b)
  {
    const vessel::CentrelineBranch& branch = tree.branches[b];
    if (branch.parent < 0)
      continue;
    const auto p = static_cast<std::size_t>(branch.parent);
    measured[b].on_parent = nearestArc(tree.branches[p], measured[p], branch.points.front());
    // A branch that continues its parent begins at the parent's end.
    const bool continues = measured[p].length() - measured[b].on_parent < kShortestCell;
    const double inside = continues ? 0.0 : radiusAt(tree.branches[p], measured[p], measured[b].on_parent);
    measured[b].begin = std::min(inside, kLongestOffset * measured[b].length());
    measured[p].children.push_back(static_cast<int>(b));
  }
  return measured;
}

/** Radius of a uniform tube with the viscous resistance of a stretch of a branch [m]. */
double resistiveRadius(const vessel::CentrelineBranch& branch, const MeasuredBranch& measured, double begin, double end)
{
  const int samples = std::max(4, static_cast<int>(std::ceil((end - begin) / kSampling)));
  double sum = 0.0;
  for (int k = 0; k < samples; ++k)
    sum += std::pow(radiusAt(branch, measured, begin + (end - begin) * (k + 0.5) / samples), -4);
  return std::pow(sum / samples, -0.25);
}

int territoryOf(int branch, const vessel::CentrelineTree& centreline, const Circulation& circulation)
{
  for (; branch >= 0; branch = centreline.branches[static_cast<std::size_t>(branch)].parent)
    for (std::size_t t = 0; t < circulation.territories.size(); ++t)
      if (circulation.territories[t].branch == centreline.branches[static_cast<std::size_t>(branch)].name)
        return static_cast<int>(t);
  return -1;
}

/** Builds the network branch by branch, parents first. */
class Builder
{
public:
  Builder(const vessel::CentrelineTree& centreline, const Circulation& circulation, const CellLengths& lengths,
          const std::vector<bool>& fine)
    : centreline_(centreline), circulation_(circulation), lengths_(lengths), fine_(fine), measured_(measure(centreline))
  {
  }

  VesselFlowTree build()
  {
    result_.ranges.resize(centreline_.branches.size());
    result_.inlet_radius = centreline_.branches[0].radii.front();
    addBranch(0, 0);
    return std::move(result_);
  }

private:
  void addBranch(int index, int node)
  {
    const auto b = static_cast<std::size_t>(index);
    MeasuredBranch& branch = measured_[b];
    std::sort(branch.children.begin(), branch.children.end(),
              [this](int x, int y) {
                return measured_[static_cast<std::size_t>(x)].on_parent <
                       measured_[static_cast<std::size_t>(y)].on_parent;
              });
    double at = branch.begin;
    std::size_t child = 0;
    while (child < branch.children.size())
    {
      const double place = measured_[static_cast<std::size_t>(branch.children[child])].on_parent;
      if (place - at >= kShortestCell && branch.length() - place >= kShortestCell)
      {
        node = addCells(index, at, place, node);
        at = place;
      }
      else if (place - at >= kShortestCell)
        break;  // at the end of the branch
      addLater(branch.children[child++], node);
    }
    // A trunk may end as a cap between its last branches.
    const double rest = branch.length() - at;
    const bool is_cap = child == branch.children.size() && child > 0 &&
                        rest < std::max(kShortestCell, kCap * centreline_.branches[b].radii.back());
    if (!is_cap)
      node = addCells(index, at, branch.length(), node);
    const bool is_end = child == branch.children.size() && !is_cap;
    for (; child < branch.children.size(); ++child)
      addLater(branch.children[child], node);
    if (is_end)
      result_.outlets.push_back(
          {index, node, centreline_.branches[b].radii.back(), territoryOf(index, centreline_, circulation_)});
    const std::vector<std::pair<int, int>> later = std::move(later_);
    later_.clear();
    for (const auto& [next, from] : later)
      addBranch(next, from);
  }

  void addLater(int branch, int node) { later_.emplace_back(branch, node); }

  /** @return the last node */
  int addCells(int index, double begin, double end, int node)
  {
    const auto b = static_cast<std::size_t>(index);
    const double usual = fine_[b] ? lengths_.in_lesions : lengths_.usual;
    const int count = std::max(1, static_cast<int>(std::lround((end - begin) / usual)));
    const int segment = segments_++;
    CellRange& range = result_.ranges[b];
    if (range.begin == range.end)
      range.begin = result_.tree.cells.size();
    for (int k = 0; k < count; ++k)
    {
      CellPlace place{index, begin + (end - begin) * k / count, begin + (end - begin) * (k + 1) / count};
      const double radius = resistiveRadius(centreline_.branches[b], measured_[b], place.begin, place.end);
      FlowCell cell;
      cell.from = node;
      cell.to = node = result_.tree.nodes++;
      cell.segment = segment;
      cell.length = place.end - place.begin;
      cell.wall = {kPi * radius * radius, 4.0 / 3.0 * circulation_.wall.at(radius)};
      cell.profile = radius > kFlatProfile ? 9.0 : 2.0;
      cell.inertia = radius > kFlatProfile ? 1.0 : 4.0 / 3.0;
      result_.tree.cells.push_back(cell);
      result_.places.push_back(place);
    }
    range.end = result_.tree.cells.size();
    return node;
  }

  const vessel::CentrelineTree& centreline_;
  const Circulation& circulation_;
  const CellLengths lengths_;
  const std::vector<bool>& fine_;
  std::vector<MeasuredBranch> measured_;
  std::vector<std::pair<int, int>> later_;
  VesselFlowTree result_;
  int segments_ = 0;
};

/** @throws InputError for a branch that has no place in a tree, or no lumen */
void checkBranch(const vessel::CentrelineTree& centreline, std::size_t index)
{
  const vessel::CentrelineBranch& branch = centreline.branches[index];
  const auto require = [&branch](bool holds, const std::string& remedy)
  {
    if (!holds)
      throw InputError("flow", "centreline, branch \"" + branch.name + "\"", remedy);
  };
  require(
      branch.parent < static_cast<int>(index),
      "its parent is not an earlier branch, so that the vessel may have a loop; list parents before their children");
  require((branch.parent < 0) == (index == 0),
          index == 0 ? "the first branch has a parent; begin with the root"
                     : "it has no parent as the first branch, and blood enters at one place; name its parent");
  require(branch.points.size() >= 2 && branch.radii.size() == branch.points.size(),
          "it has " + std::to_string(branch.points.size()) + " points and " + std::to_string(branch.radii.size()) +
              " radii; give two or more points, each with a radius");
  double length = 0.0;
  for (std::size_t k = 1; k < branch.points.size(); ++k)
    length += (branch.points[k] - branch.points[k - 1]).norm();
  require(std::isfinite(length) && length > 0.0, "its length is not positive; give points at different places");
  require(std::all_of(branch.radii.begin(), branch.radii.end(),
                      [](double radius) { return std::isfinite(radius) && radius > 0.0; }),
          "a radius is not positive; give radii in metres");
}

}  // namespace

vessel::CentrelineTree withoutLesions(vessel::CentrelineTree centreline,
                                      const std::vector<vessel::PlacedLesion>& lesions)
{
  const vessel::CentrelineTree given = centreline;
  const std::vector<MeasuredBranch> measured = measure(given);
  for (const vessel::PlacedLesion& lesion : lesions)
  {
    const auto b = static_cast<std::size_t>(lesion.branch);
    const double before = radiusAt(given.branches[b], measured[b], lesion.begin);
    const double behind = radiusAt(given.branches[b], measured[b], lesion.end);
    for (std::size_t k = 0; k < measured[b].arcs.size(); ++k)
    {
      const double share = (measured[b].arcs[k] - lesion.begin) / (lesion.end - lesion.begin);
      if (share > 0.0 && share < 1.0)
        centreline.branches[b].radii[k] = before + share * (behind - before);
    }
  }
  return centreline;
}

VesselFlowTree vesselFlowTree(const vessel::CentrelineTree& centreline, const Circulation& circulation,
                              const CellLengths& lengths, const std::vector<bool>& fine)
{
  if (centreline.branches.empty())
    throw InputError("flow", "centreline", "the vessel has no centreline; give vessel.centreline");
  if (fine.size() != centreline.branches.size())
    throw std::invalid_argument("flow: the length of cells is needed for each branch");
  for (std::size_t b = 0; b < centreline.branches.size(); ++b)
    checkBranch(centreline, b);
  return Builder(centreline, circulation, lengths, fine).build();
}

}  // namespace endovascular_sim::flow
