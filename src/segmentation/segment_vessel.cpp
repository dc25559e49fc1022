#include "segmentation/segment_vessel.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstdio>

#include "common/error.h"
#include "common/numerics/parallel_for.h"
#include "segmentation/lumen/click_check.h"
#include "segmentation/lumen/minimal_path.h"
#include "segmentation/surface/tube.h"

namespace endovascular_sim::segmentation
{
namespace
{

using Points = std::vector<Eigen::Vector3d>;

constexpr double kLongestGap = 2.0e-3;     ///< stretch of a path outside of the lumen that means two vessels [m]
constexpr double kFarthest = 0.012;        ///< of a branch from its parent [m]
constexpr double kWidestWithLimit = 0.01;  ///< radius up to which wide regions are closed to a path [m]
constexpr double kWideShare = 0.75;        ///< of the largest radius: radius of a wide region

WideRegions wideRegions(const Scan& scan, const CheckedBranch& branch)
{
  if (branch.largest_radius > kWidestWithLimit)
    return {};
  double darkest = branch.clicks.front().value;
  double brightest = darkest;
  for (const LumenAtClick& click : branch.clicks)
  {
    darkest = std::min(darkest, click.value);
    brightest = std::max(brightest, click.value);
  }
  const LumenRange range{darkest, brightest, branch.background};
  return {scan, range.threshold(), kWideShare * branch.largest_radius};
}

std::string textOf(const Eigen::Vector3d& p)
{
  char text[100];
  std::snprintf(text, sizeof text, "(%.1f, %.1f, %.1f) mm", 1e3 * p.x(), 1e3 * p.y(), 1e3 * p.z());
  return text;
}

/** Path through all clicks of a branch. */
Points pathOf(const Scan& scan, const ClickSet& clicks, const CheckedBranch& branch)
{
  const WideRegions wide = wideRegions(scan, branch);
  Points points{branch.clicks.front().position};
  for (std::size_t k = 0; k + 1 < branch.clicks.size(); ++k)
  {
    const MinimalPath path =
        minimalPath(scan, branch.clicks[k].position, branch.clicks[k + 1].position, branch.range(k), wide);
    if (path.longest_gap > kLongestGap)
      throw InputError(clicks.file, branch.name,
                       "clicks " + std::to_string(k + 1) + " and " + std::to_string(k + 2) +
                           " lie in two vessels: the path between them leaves the contrast for " +
                           std::to_string(path.longest_gap * 1e3).substr(0, 4) + " mm at " +
                           textOf(scan.toPatient(path.gap_location)) +
                           "; correct a click, add one between them, or end the branch at an occlusion");
    points.insert(points.end(), path.points.begin() + 1, path.points.end());
  }
  return points;
}

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
  }
}

/** Tree of the branches: parents by the shortest distance, beginning with the widest branch. */
class Joining
{
public:
  Joining(const Scan& scan, const ClickSet& clicks, const EdgeSettings& settings, Segmentation& segmentation)
    : scan_(scan), clicks_(clicks), settings_(settings), branches_(segmentation.branches)
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
      if (best.distance > kFarthest)
        throw InputError(
            clicks_.file, branch.name,
            "is " + std::to_string(static_cast<int>(1e3 * best.distance)) +
                " mm away from all other branches; add the branch between them, or click closer to its ostium");
      branch.parent = best.parent;
      if (best.reversed)
        reverse(branch);
      attachments_[static_cast<std::size_t>(best.child)] = best;
      joined.push_back(best.child);
    }
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
    double darkest = 1e30;
    double brightest = -1e30;
    for (const LumenAtClick& click : checked_[child].clicks)
    {
      darkest = std::min(darkest, click.value);
      brightest = std::max(brightest, click.value);
    }
    const LumenRange range{darkest, brightest, checked_[child].background};
    const MinimalPath way = minimalPath(scan_, from, branch.sections.front().centre, range, {});
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
    branches_[child].sections = fitLumen(scan_, path, branch.largest_radius, settings_);
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
  std::vector<CheckedBranch> checked_;
  std::vector<Attachment> attachments_;
};

}  // namespace

Segmentation segmentBranches(const Scan& scan, const ClickSet& clicks, const EdgeSettings& settings, int threads,
                             const ProgressReport& progress)
{
  Segmentation result;
  reportProgress(progress, "checking the clicks");
  const std::vector<CheckedBranch> checked = checkClicks(scan, clicks, result.warnings);
  result.branches.resize(checked.size());
  reportProgress(progress, "segmenting the branches");
  parallelFor(checked.size(), threadCount(threads),
              [&](std::size_t b)
              {
                LumenBranch& branch = result.branches[b];
                branch.name = checked[b].name;
                branch.largest_radius = checked[b].largest_radius;
                branch.sections = fitLumen(scan, pathOf(scan, clicks, checked[b]), checked[b].largest_radius, settings);
              });
  return result;
}

void joinBranches(const Scan& scan, const ClickSet& clicks, const EdgeSettings& settings, int threads,
                  Segmentation& segmentation)
{
  Joining(scan, clicks, settings, segmentation).run(threadCount(threads));
}

}  // namespace endovascular_sim::segmentation
