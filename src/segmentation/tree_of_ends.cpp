#include "segmentation/tree_of_ends.h"

#include <algorithm>
#include <cstddef>

#include "common/error.h"
#include "segmentation/branch_path.h"
#include "segmentation/lumen/click_check.h"
#include "segmentation/surface/tube.h"

namespace endovascular_sim::segmentation
{
namespace
{

constexpr double kMargin = 1e-3;  ///< of the tubes [m]

/** Branches of one tree, from the clicks at its ends. */
class TreeOfEnds
{
public:
  TreeOfEnds(const Scan& scan, const BranchClicks& ends, const std::string& file, const EdgeSettings& settings)
    : scan_(scan), ends_(ends), file_(file), settings_(settings)
  {
  }

  std::vector<BranchClicks> run(std::vector<std::string>& warnings)
  {
    checkEnds(warnings);
    std::vector<std::size_t> order;  // widest first
    for (std::size_t k = 1; k < ends_.clicks.size(); ++k)
      order.push_back(k);
    std::stable_sort(order.begin(), order.end(),
                     [this](std::size_t a, std::size_t b)
                     { return checked_.clicks[a].radius > checked_.clicks[b].radius; });
    for (const std::size_t end : order)
      addBranch(end, warnings);
    return branches_;
  }

private:
  void checkEnds(std::vector<std::string>& warnings)
  {
    ClickSet own;
    own.file = file_;
    own.branches = {ends_};
    checked_ = checkClicks(scan_, own, warnings).front();
  }

  /** Adds the part of the path to an end that lies outside of the lumens that are there. */
  void addBranch(std::size_t end, std::vector<std::string>& warnings)
  {
    CheckedBranch pair = checked_;
    pair.clicks = {checked_.clicks.front(), checked_.clicks[end]};
    if (!pair.isBounded())
      pair.largest_radius = pair.radiusBound(0);
    const std::vector<Eigen::Vector3d> path = branchPath(scan_, pair, file_).points;
    std::size_t begin = 0;
    for (std::size_t k = 0; k < path.size(); ++k)
      if (std::any_of(lumens_.begin(), lumens_.end(),
                      [&](const Tube& lumen) { return lumen.at(path[k]).distance < 0.0; }))
        begin = k;
    if (begin + 2 >= path.size())
    {
      warnings.push_back(ends_.name + ": click " + std::to_string(end + 1) +
                         " lies on the way to another end, and gets no branch");
      return;
    }
    BranchClicks branch = ends_;
    branch.are_ends = false;
    branch.clicks = {ends_.clicks.front(), ends_.clicks[end]};
    if (begin > 0)
      branch.clicks.front().position = scan_.toPatient(path[begin + 1]);
    if (!branches_.empty())
    {
      branch.name += "_" + std::to_string(end + 1);
      warnings.push_back(ends_.name + ": click " + std::to_string(end + 1) + " is the end of a branch of its own, " +
                         branch.name);
    }
    branches_.push_back(branch);
    const std::vector<Eigen::Vector3d> rest(path.begin() + static_cast<std::ptrdiff_t>(begin), path.end());
    lumens_.emplace_back(fitLumen(scan_, rest, RayReach(pair.largest_radius), settings_), kMargin);
  }

  const Scan& scan_;
  const BranchClicks& ends_;
  const std::string& file_;
  const EdgeSettings& settings_;
  CheckedBranch checked_;
  std::vector<BranchClicks> branches_;
  std::vector<Tube> lumens_;
};

}  // namespace

ClickSet withBranchPerEnd(const Scan& scan, const ClickSet& clicks, const EdgeSettings& settings,
                          std::vector<std::string>& warnings)
{
  ClickSet result = clicks;
  result.branches.clear();
  for (const BranchClicks& branch : clicks.branches)
  {
    if (!branch.are_ends)
    {
      result.branches.push_back(branch);
      continue;
    }
    for (const BranchClicks& part : TreeOfEnds(scan, branch, clicks.file, settings).run(warnings))
      result.branches.push_back(part);
  }
  requireDifferentNames(result);
  return result;
}

}  // namespace endovascular_sim::segmentation
