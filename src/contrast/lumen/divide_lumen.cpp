#include "contrast/lumen/divide_lumen.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "common/error.h"
#include "contrast/lumen/branch_line.h"
#include "contrast/lumen/cell_complex.h"

namespace endovascular_sim::contrast
{
namespace
{

constexpr double kRounding = 1e-9;  // of arc lengths [m]
constexpr double kPi = 3.14159265358979323846;
constexpr double kMouthStep = 0.25;     // between planes that are tried as mouths, in radii
constexpr double kShortestStep = 1e-4;  // the same [m]
constexpr double kOnPlane = 1e-6;       // distance of a point that lies on a plane [m]
constexpr double kMouthWindow = 8.0;    // in which a mouth is sought, in radii of the parent: for forks from 15° on
constexpr double kLatestMouth = 0.8;    // in lengths of the branch
constexpr double kSmallestPiece = 0.3;  // of a cell behind its branch's mouth that is a part of its own

/** Divides branch by branch, distal ones first. The remaining lumen holds the proximal branches. */
class Divider
{
public:
  Divider(const geometry::TriangleMesh& mesh, const vessel::CentrelineTree& tree, const ContrastCells& cells)
    : mesh_(mesh),
      tree_(tree),
      cells_(cells),
      complex_(mesh),
      cells_of_branch_(tree.branches.size()),
      region_of_cell_(cells.size(), -1),
      mouths_(tree.branches.size(), std::numeric_limits<double>::quiet_NaN())
  {
    for (const vessel::CentrelineBranch& branch : tree.branches)
      lines_.emplace_back(branch);
    for (std::size_t k = 0; k < cells.size(); ++k)
      cells_of_branch_[static_cast<std::size_t>(cells[k].branch)].push_back(k);
    const Eigen::Vector3d inlet = lines_.front().line().points().front();
    for (std::size_t k = 1; k < mesh.vertices.size(); ++k)
      if ((mesh.vertices[k] - inlet).squaredNorm() < (mesh.vertices[at_inlet_] - inlet).squaredNorm())
        at_inlet_ = k;
  }

  LumenCells divide()
  {
    for (std::size_t b = tree_.branches.size(); b-- > 0;)
      divideBranch(b);
    for (const std::size_t k : lost_)
      region_of_cell_[k] = regionAround(k);
    for (std::size_t k = 0; k < cells_.size(); ++k)
      if (region_of_cell_[k] < 0)  // inside of the lumen of the parent
        region_of_cell_[k] = region_of_cell_[static_cast<std::size_t>(cells_[k].parent)];
    return result();
  }

private:
  bool descends(std::size_t branch, std::size_t ancestor) const
  {
    for (int k = static_cast<int>(branch); k >= 0; k = tree_.branches[static_cast<std::size_t>(k)].parent)
      if (k == static_cast<int>(ancestor))
        return true;
    return false;
  }

  /** True if a branch that is not behind branch b passes through the rim of a section, or begins in it: the plane cuts
   * the lumen of the parent, or of a sibling, too. */
  bool holdsOthers(std::size_t b, const CutPlane& plane, const Section& rim) const
  {
    for (std::size_t other = 0; other < tree_.branches.size(); ++other)
    {
      if (descends(other, b))
        continue;
      const std::vector<Eigen::Vector3d>& points = lines_[other].line().points();
      const auto height = [&plane](const Eigen::Vector3d& p) { return plane.normal.dot(p - plane.point); };
      if (other > 0 && std::abs(height(points.front())) < kOnPlane && rim.surrounds(points.front(), plane.normal))
        return true;
      std::size_t last = points.size();  // the last one beside the plane
      for (std::size_t k = 0; k < points.size(); ++k)
      {
        const double z = height(points[k]);
        if (std::abs(z) <= kOnPlane)
          continue;
        const double a = last < k ? height(points[last]) : z;
        if ((a < 0.0) != (z < 0.0) &&
            rim.surrounds(points[last] + a / (a - z) * (points[k] - points[last]), plane.normal))
          return true;
        last = k;
      }
    }
    return false;
  }

  /** Mouth of a branch: plane and rim, sought from its first cell on. */
  std::optional<std::pair<double, Section>> mouthOf(std::size_t b, double begin)
  {
    const BranchLine& line = lines_[b];
    const BranchLine& parent = lines_[static_cast<std::size_t>(tree_.branches[b].parent)];
    const double parent_radius = parent.radiusAt(parent.line().nearest(line.line().at(begin)).arc);
    const double last = std::min(begin + kMouthWindow * parent_radius, kLatestMouth * line.length());
    std::optional<std::pair<double, Section>> best;
    double least = std::numeric_limits<double>::infinity();
    for (double arc = begin; arc <= last || arc == begin;
         arc += std::max(kMouthStep * line.radiusAt(arc), kShortestStep))
    {
      std::optional<Section> rim = complex_.section(rest_, line.planeAt(arc));
      if (!rim || rim->reach / line.radiusAt(arc) >= least || holdsOthers(b, line.planeAt(arc), *rim))
        continue;
      least = rim->reach / line.radiusAt(arc);
      best = std::make_pair(arc, std::move(*rim));
      if (least <= kWidestMouth)
        break;
    }
    return best;
  }

  /** Cuts a region, and keeps track of the rest. */
  std::optional<CellComplex::Sides> cut(int region, const CutPlane& plane, const Section& section)
  {
    const std::optional<CellComplex::Sides> sides = complex_.cut(region, plane, section);
    rest_ = complex_.regionAt(static_cast<int>(at_inlet_));
    return sides;
  }

  /** Region that holds a branch: cut off from the rest, or the rest, if the branch is part of a loop; −1 without a
   *  mouth. */
  int regionOf(std::size_t b, double begin)
  {
    if (tree_.branches[b].parent < 0)
    {
      mouths_[b] = begin;
      return rest_;
    }
    const std::optional<std::pair<double, Section>> mouth = mouthOf(b, begin);
    if (!mouth)
      return -1;
    mouths_[b] = mouth->first;
    const std::optional<CellComplex::Sides> sides = cut(rest_, lines_[b].planeAt(mouth->first), mouth->second);
    return sides ? sides->before : rest_;
  }

  void divideBranch(std::size_t b)
  {
    const std::vector<std::size_t>& own = cells_of_branch_[b];
    if (own.empty())
      return;
    int region = regionOf(b, cells_[own.front()].begin);
    if (region < 0)
      return;
    std::vector<std::size_t> waiting;  // cells of the next part
    for (const std::size_t k : own)
    {
      const ContrastCell& cell = cells_[k];
      const bool last = k == own.back();
      if (!last && cell.end <= mouths_[b])
        continue;
      waiting.push_back(k);
      if (!last && cell.end - mouths_[b] < kSmallestPiece * (cell.end - cell.begin))
        continue;
      const std::optional<int> part = last ? region : cutAt(b, cell.end, region);
      if (!part)
        continue;
      const bool is_known = *part >= 0 && (*part != rest_ || tree_.branches[b].parent < 0);
      if (!is_known)
        lost_.insert(lost_.end(), waiting.begin(), waiting.end());
      for (const std::size_t w : waiting)
        region_of_cell_[w] = is_known ? *part : -1;
      waiting.clear();
    }
  }

  /** Part behind the plane at an arc length; −1 if it is not yet known, because the region has a handle there; empty if
   *  the plane does not cut the region. @param region the rest */
  std::optional<int> cutAt(std::size_t b, double arc, int& region)
  {
    const CutPlane plane = lines_[b].planeAt(arc);
    const std::optional<Section> section = complex_.section(region, plane);
    if (!section)
      return std::nullopt;
    const std::optional<CellComplex::Sides> sides = cut(region, plane, *section);
    if (!sides)
      return -1;
    region = sides->before;
    return sides->behind;
  }

  /** Region around the middle of a cell; −1 if there is none. */
  int regionAround(std::size_t k)
  {
    const ContrastCell& cell = cells_[k];
    const CutPlane plane = lines_[static_cast<std::size_t>(cell.branch)].planeAt(0.5 * (cell.begin + cell.end));
    int nearest = -1;
    double least = std::numeric_limits<double>::infinity();
    for (int region = 0; region < static_cast<int>(complex_.regions()); ++region)
      if (const std::optional<Section> section = complex_.section(region, plane); section && section->reach < least)
      {
        least = section->reach;
        nearest = region;
      }
    return nearest;
  }

  /** Parts of the regions. One without a cell belongs to that of a neighbour. */
  std::vector<int> numberParts(LumenCells& lumen) const
  {
    std::vector<int> part_of_region(complex_.regions(), -1);
    for (const int region : region_of_cell_)
    {
      int& part = part_of_region[static_cast<std::size_t>(region)];
      if (part < 0)
        part = static_cast<int>(lumen.parts++);
      lumen.part_of_cell.push_back(part);
    }
    for (bool is_complete = false; !is_complete;)
    {
      is_complete = true;
      for (const CellComplex::Face& face : complex_.faces())
        if (face.minus >= 0)
        {
          int &plus = part_of_region[static_cast<std::size_t>(face.plus)],
              &minus = part_of_region[static_cast<std::size_t>(face.minus)];
          is_complete = is_complete && (plus < 0) == (minus < 0);
          plus = plus < 0 ? minus : plus;
          minus = minus < 0 ? plus : minus;
        }
    }
    return part_of_region;
  }

  LumenCells result() const
  {
    LumenCells lumen;
    lumen.mesh_vertices = mesh_.vertices.size();
    lumen.triangles = mesh_.triangles;
    lumen.cuts = complex_.cuts();
    lumen.mouths = mouths_;
    const std::vector<int> part_of_region = numberParts(lumen);
    const auto partOf = [&](int region) { return part_of_region[static_cast<std::size_t>(region)]; };
    for (const CellComplex::Face& face : complex_.faces())
      if (face.minus < 0)
        lumen.walls.push_back({face.corners, partOf(face.plus), face.triangle});
      else if (partOf(face.plus) != partOf(face.minus))
        lumen.caps.push_back({face.corners, partOf(face.plus), partOf(face.minus)});
    std::stable_sort(lumen.walls.begin(), lumen.walls.end(),
                     [](const WallPiece& a, const WallPiece& b) { return a.triangle < b.triangle; });
    shareVolumes(lumen);
    return lumen;
  }

  void shareVolumes(LumenCells& lumen) const
  {
    const std::vector<double> of_parts = lumen.partVolumes(lumen.place(mesh_.vertices));
    std::vector<double> nominal, sums(lumen.parts, 0.0);
    for (std::size_t k = 0; k < cells_.size(); ++k)
    {
      const ContrastCell& cell = cells_[k];
      const double radius = lines_[static_cast<std::size_t>(cell.branch)].radiusAt(0.5 * (cell.begin + cell.end));
      nominal.push_back(kPi * radius * radius * (cell.end - cell.begin));
      sums[static_cast<std::size_t>(lumen.part_of_cell[k])] += nominal.back();
    }
    for (std::size_t k = 0; k < cells_.size(); ++k)
    {
      const auto part = static_cast<std::size_t>(lumen.part_of_cell[k]);
      lumen.of_part.push_back(nominal[k] / sums[part]);
      lumen.volumes.push_back(lumen.of_part.back() * of_parts[part]);
    }
  }

  const geometry::TriangleMesh& mesh_;
  const vessel::CentrelineTree& tree_;
  const ContrastCells& cells_;
  CellComplex complex_;
  std::vector<BranchLine> lines_;
  std::vector<std::vector<std::size_t>> cells_of_branch_;
  std::vector<int> region_of_cell_;
  std::vector<std::size_t> lost_;  ///< cells whose region is not known before all cuts are made
  std::vector<double> mouths_;
  std::size_t at_inlet_ = 0;  ///< vertex near the beginning of the root
  int rest_ = 0;              ///< region of the inlet, and of the branches that are not yet cut off
};

void check(const vessel::CentrelineTree& tree, const ContrastCells& cells)
{
  const auto require = [](bool holds, const std::string& where, const std::string& remedy)
  {
    if (!holds)
      throw InputError("contrast", where, remedy);
  };
  for (std::size_t b = 0; b < tree.branches.size(); ++b)
    require(tree.branches[b].parent < static_cast<int>(b) && (tree.branches[b].parent < 0) == (b == 0),
            "centreline, branch \"" + tree.branches[b].name + "\"", "list the root first, and parents before children");
  std::vector<double> reached(tree.branches.size(), 0.0);
  for (std::size_t k = 0; k < cells.size(); ++k)
  {
    const ContrastCell& cell = cells[k];
    const std::string where = "cell " + std::to_string(k);
    require(cell.branch >= 0 && cell.branch < static_cast<int>(tree.branches.size()), where,
            "names a branch that the centreline does not have");
    double& begin = reached[static_cast<std::size_t>(cell.branch)];
    require(cell.begin >= begin - kRounding && cell.end > cell.begin, where,
            "list cells by increasing arc length on their branch");
    begin = cell.end;
    require(cell.parent < static_cast<int>(k) && (cell.parent < 0) == (k == 0), where,
            "list the cell of the inlet first, and parents before children");
  }
  require(!cells.empty() && cells.front().branch == 0, "cells", "the first one must lie on the root");
}

}  // namespace

LumenCells divideLumen(const geometry::TriangleMesh& mesh, const vessel::CentrelineTree& centreline,
                       const ContrastCells& cells)
{
  check(centreline, cells);
  return Divider(mesh, centreline, cells).divide();
}

}  // namespace endovascular_sim::contrast
