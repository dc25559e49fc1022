#include "segmentation/join_branches.h"

#include <algorithm>
#include <string>
#include <vector>

#include "common/error.h"
#include "common/numerics/parallel_for.h"
#include "common/text/format.h"
#include "segmentation/lumen/click_check.h"
#include "segmentation/lumen/lumen_fit.h"
#include "segmentation/lumen/minimal_path.h"
#include "segmentation/surface/tube.h"

namespace endovascular_sim::segmentation
{
namespace
{

using Points = std::vector<Eigen::Vector3d>;

constexpr double kTouching = 0.003;  ///< distance of a branch from its parent up to which it is the nearest one [m]
constexpr double kNear = 0.012;      ///< distance of a branch from its parent that needs no warning [m]
constexpr double kFarthest = 0.030;  ///< largest distance of a branch from its parent [m]

double meanRadius(const LumenBranch& branch)
{
  double sum = 0.0;
  for (const Section& section : branch.sections)
    sum += 0.5 * section.diameter();
  return sum / static_cast<double>(branch.sections.size());
}

/** Place at which a branch could join another one. */
struct Attachment
{
  double distance = 1e30;  ///< from the end of the branch to the lumen of the other one [m]
  int child = -1;
  int parent = -1;
  bool reversed = false;
  std::size_t section = 0;  ///< nearest section of the parent
};

Attachment attachmentOf(const std::vector<LumenBranch>& branches, int child, int parent)
{
  Attachment best;
  for (const bool reversed : {false, true})
  {
    const std::vector<Section>& own = branches[static_cast<std::size_t>(child)].sections;
    const Eigen::Vector3d& end = reversed ? own.back().centre : own.front().centre;
    const std::vector<Section>& others = branches[static_cast<std::size_t>(parent)].sections;
    for (std::size_t s = 0; s < others.size(); ++s)
    {
      const double distance = (others[s].centre - end).norm() - 0.5 * others[s].diameter();
      if (distance < best.distance)
        best = {distance, child, parent, reversed, s};
    }
  }
  return best;
}

void reverse(LumenBranch& branch)
{
  std::reverse(branch.sections.begin(), branch.sections.end());
  for (Section& section : branch.sections)
  {
    section.tangent = -section.tangent;
    section.w = -section.w;
    std::reverse(section.radii.begin() + 1, section.radii.end());
    std::reverse(section.ends.begin() + 1, section.ends.end());
  }
}

/** Tree of the branches: parents by the shortest distance, beginning with the widest branch. */
class Joining
{
public:
  Joining(const Scan& scan, const ClickSet& clicks, const EdgeSettings& settings, Segmentation& segmentation)
    : scan_(scan),
      clicks_(clicks),
      settings_(settings),
      branches_(segmentation.branches),
      warnings_(segmentation.warnings)
  {
  }

  void run(int threads)
  {
    std::vector<std::string> ignored;
    checked_ = checkClicks(scan_, clicks_, ignored);
    findParents();
    const std::vector<LumenBranch> before = branches_;
    parallelFor(branches_.size(), threads,
                [&](std::size_t b)
                {
                  if (branches_[b].parent >= 0)
                    extend(before, b);
                });
  }

private:
  void findParents()
  {
    const int n = static_cast<int>(branches_.size());
    int root = 0;
    for (int b = 1; b < n; ++b)
      if (meanRadius(branches_[static_cast<std::size_t>(b)]) > meanRadius(branches_[static_cast<std::size_t>(root)]))
        root = b;
    std::vector<int> joined{root};
    attachments_.resize(branches_.size());
    while (static_cast<int>(joined.size()) < n)
    {
      Attachment best;
      for (int child = 0; child < n; ++child)
      {
        if (std::find(joined.begin(), joined.end(), child) != joined.end())
          continue;
        for (const int parent : joined)
          if (const Attachment attachment = attachmentOf(branches_, child, parent);
              best.child < 0 || attachment.distance < best.distance)
            best = attachment;
      }
      LumenBranch& branch = branches_[static_cast<std::size_t>(best.child)];
      if (best.distance > kTouching)
        best = connectedThroughLumen(best, joined);
      if (best.distance > kFarthest)
        throw InputError(
            clicks_.file, branch.name,
            "is " + std::to_string(static_cast<int>(1e3 * best.distance)) +
                " mm away from all other branches; add the branch between them, or click closer to its ostium");
      branch.parent = best.parent;
      if (best.distance > kNear)
        warnings_.push_back(branch.name + ": was extended by about " +
                            std::to_string(static_cast<int>(1e3 * best.distance)) + " mm to " +
                            branches_[static_cast<std::size_t>(best.parent)].name +
                            "; check the begin of its straightened view, or click closer to its ostium");
      if (best.reversed)
        reverse(branch);
      attachments_[static_cast<std::size_t>(best.child)] = best;
      joined.push_back(best.child);
    }
  }

  /** The branch whose lumen the path from the child to the root meets first. Near branches of a fork are close to each
   * other, but the way between them leads through their common parent. Without such a path, the nearest branch. */
  Attachment connectedThroughLumen(const Attachment& nearest, const std::vector<int>& joined) const
  {
    const LumenBranch& child = branches_[static_cast<std::size_t>(nearest.child)];
    const Section& end = nearest.reversed ? child.sections.back() : child.sections.front();
    const Attachment to_root = attachmentOf(branches_, nearest.child, joined.front());
    const Section& on_root = branches_[static_cast<std::size_t>(joined.front())].sections[to_root.section];
    const MinimalPath path =
        minimalPath(scan_, end.centre, on_root.centre, rangeOf(static_cast<std::size_t>(nearest.child)), {});
    if (path.leavesLumen())
      return nearest;
    for (const Eigen::Vector3d& p : path.points)
      for (const int parent : joined)
      {
        const std::vector<Section>& sections = branches_[static_cast<std::size_t>(parent)].sections;
        for (std::size_t s = 0; s < sections.size(); ++s)
          if ((sections[s].centre - p).norm() < 0.5 * sections[s].diameter())
          {
            const double distance = (sections[s].centre - end.centre).norm() - 0.5 * sections[s].diameter();
            return {distance, nearest.child, parent, nearest.reversed, s};
          }
      }
    return nearest;
  }

  LumenRange rangeOf(std::size_t branch) const
  {
    double darkest = 1e30;
    double brightest = -1e30;
    for (const LumenAtClick& click : checked_[branch].clicks)
    {
      darkest = std::min(darkest, click.value);
      brightest = std::max(brightest, click.value);
    }
    return {darkest, brightest, checked_[branch].background};
  }

  /** Extends a branch into the lumen of its parent. */
  void extend(const std::vector<LumenBranch>& before, std::size_t child)
  {
    const Attachment& attachment = attachments_[child];
    const LumenBranch& branch = before[child];
    const std::vector<Section>& parent = before[static_cast<std::size_t>(attachment.parent)].sections;
    const double radius = 0.5 * branch.sections.front().diameter();
    Points path = upstreamOf(parent, attachment.section, 2.5 * radius);
    const Eigen::Vector3d from = path.back();
    const MinimalPath way = minimalPath(scan_, from, branch.sections.front().centre, rangeOf(child), {});
    if (attachment.distance > kNear && way.leavesLumen())
      throw InputError(clicks_.file, branch.name,
                       "is " + std::to_string(static_cast<int>(1e3 * attachment.distance)) +
                           " mm away from the nearest branch, and the path between them leaves the contrast at " +
                           inMillimetres(scan_.toPatient(way.gap_location)) +
                           "; add the branch between them, or click closer to its ostium");
    path.insert(path.end(), way.points.begin() + 1, way.points.end());
    for (std::size_t s = 1; s < branch.sections.size(); ++s)
      path.push_back(branch.sections[s].centre);
    // The branch begins where its lumen is inside of the parent's.
    const Tube tube(parent, 1e-3);
    const double depth = std::min(1.2 * radius, 0.4 * parent[attachment.section].diameter());
    std::size_t begin = 0;
    const std::size_t before_branch = path.size() - branch.sections.size() + 1;
    for (std::size_t k = 0; k < before_branch; ++k)
      if (tube.at(path[k]).distance < -depth && (path[k] - parent.front().centre).norm() > depth &&
          (path[k] - parent.back().centre).norm() > depth)  // not at a flat end of the parent
        begin = k;
    path.erase(path.begin(), path.begin() + static_cast<std::ptrdiff_t>(begin));
    branches_[child].sections = fitLumen(scan_, path, RayReach(branch.largest_radius, branch.sections), settings_);
  }

  /** Centres of the parent before a section, from a distance up to the section. */
  static Points upstreamOf(const std::vector<Section>& parent, std::size_t section, double distance)
  {
    Points points{parent[section].centre};
    double passed = 0.0;
    for (std::size_t s = section; s > 0 && passed < distance; --s)
    {
      passed += (parent[s].centre - parent[s - 1].centre).norm();
      points.insert(points.begin(), parent[s - 1].centre);
    }
    return points;
  }

  const Scan& scan_;
  const ClickSet& clicks_;
  const EdgeSettings& settings_;
  std::vector<LumenBranch>& branches_;
  std::vector<std::string>& warnings_;
  std::vector<CheckedBranch> checked_;
  std::vector<Attachment> attachments_;
};

}  // namespace

void joinBranches(const Scan& scan, const ClickSet& clicks, const EdgeSettings& settings, int threads,
                  Segmentation& segmentation)
{
  Joining(scan, clicks, settings, segmentation).run(threadCount(threads));
}

}  // namespace endovascular_sim::segmentation
