#include "vessel/centreline/medial_skeleton.h"

#include <algorithm>
#include <functional>
#include <queue>

namespace endovascular_sim::vessel
{
namespace
{

/** Distance covered by a path, in radii. The rim of a flat cap is at √2. */
constexpr double kCover = 1.2;
/** Minimum length of a branch outside of the covered region, in radii of the branch. */
constexpr double kShortestBranch = 1.0;
/** Minimum slope of the radius along a groove that leads into a lumen. A tapering vessel has a smaller slope. */
constexpr double kGrooveSlope = 0.1;
/** Minimum radius of a tip relative to the largest sphere that is reachable along a groove. */
constexpr double kGrooveDepth = 0.5;
/** Range of a sphere, in radii, within which spheres below kGrooveDepth of its radius are no tips. Such spheres fill
 *  crevices between adjacent vessels. */
constexpr double kShadow = 2.0;
constexpr double kUnreached = 1e300;

using Graph = std::vector<std::vector<int>>;

struct Paths
{
  std::vector<double> cost;
  std::vector<int> previous;
};

/** Multi-source Dijkstra with initial costs, up to a cost limit. */
Paths shortestPaths(const std::vector<MedialSphere>& spheres, const Graph& neighbours,
                    const std::vector<std::pair<double, int>>& sources,
                    const std::function<double(int, int)>& edge_cost, double limit = kUnreached)
{
  Paths paths{std::vector<double>(spheres.size(), kUnreached), std::vector<int>(spheres.size(), -1)};
  using Entry = std::pair<double, int>;
  std::priority_queue<Entry, std::vector<Entry>, std::greater<>> open;
  for (const auto& [cost, sphere] : sources)
    if (cost < paths.cost[static_cast<std::size_t>(sphere)])
    {
      paths.cost[static_cast<std::size_t>(sphere)] = cost;
      open.push({cost, sphere});
    }
  while (!open.empty())
  {
    const auto [cost, sphere] = open.top();
    open.pop();
    if (cost > paths.cost[static_cast<std::size_t>(sphere)])
      continue;
    for (int next : neighbours[static_cast<std::size_t>(sphere)])
    {
      const double through = cost + edge_cost(sphere, next);
      if (through > limit || through >= paths.cost[static_cast<std::size_t>(next)])
        continue;
      paths.cost[static_cast<std::size_t>(next)] = through;
      paths.previous[static_cast<std::size_t>(next)] = sphere;
      open.push({through, next});
    }
  }
  return paths;
}

/** Tree of minimal paths in the graph of medial spheres (TEASAR). */
class Skeletoniser
{
public:
  Skeletoniser(const std::vector<MedialSphere>& spheres, const Graph& neighbours)
    : spheres_(spheres), neighbours_(neighbours), covered_(spheres.size(), false), tree_(spheres.size())
  {
    // Spheres are sorted by decreasing radius.
    std::vector<double> summit;
    for (std::size_t k = 0; k < spheres.size(); ++k)
    {
      const double radius = spheres[k].radius;
      summit.push_back(radius);
      for (int other : neighbours[k])
        if (other < static_cast<int>(k) &&
            at(other).radius - radius > kGrooveSlope * length(static_cast<int>(k), other))
          summit[k] = std::max(summit[k], summit[static_cast<std::size_t>(other)]);
      may_be_tip_.push_back(radius >= kGrooveDepth * summit[k]);
    }
    forbidTipsInShadows();
  }

  std::vector<SkeletonBranch> run()
  {
    const int seed = farthestFrom(largestSphere(), nullptr);
    growTree(seed);
    return branchesFrom(widestEnd());
  }

private:
  void forbidTipsInShadows()
  {
    std::vector<std::pair<double, int>> sources;
    for (std::size_t k = 0; k < spheres_.size(); ++k)
      sources.emplace_back(-kShadow * spheres_[k].radius, static_cast<int>(k));
    const Paths shadows = lengths(sources, 0.0);
    for (std::size_t k = 0; k < spheres_.size(); ++k)
    {
      int source = static_cast<int>(k);
      while (shadows.previous[static_cast<std::size_t>(source)] >= 0)
        source = shadows.previous[static_cast<std::size_t>(source)];
      if (spheres_[k].radius < kGrooveDepth * at(source).radius)
        may_be_tip_[k] = false;
    }
  }

  double length(int a, int b) const { return (at(a).centre - at(b).centre).norm(); }

  const MedialSphere& at(int k) const { return spheres_[static_cast<std::size_t>(k)]; }

  int largestSphere() const
  {
    const auto largest =
        std::max_element(spheres_.begin(), spheres_.end(),
                         [](const MedialSphere& a, const MedialSphere& b) { return a.radius < b.radius; });
    return static_cast<int>(largest - spheres_.begin());
  }

  Paths lengths(const std::vector<std::pair<double, int>>& sources, double limit = kUnreached) const
  {
    return shortestPaths(
        spheres_, neighbours_, sources, [this](int a, int b) { return length(a, b); }, limit);
  }

  /** Farthest possible tip along the lumen.
   *  @param result optional output of all distances */
  int farthestFrom(int source, std::vector<double>* result) const
  {
    Paths paths = lengths({{0.0, source}});
    int farthest = source;
    for (std::size_t k = 0; k < spheres_.size(); ++k)
      if (may_be_tip_[k] && paths.cost[k] < kUnreached &&
          paths.cost[k] > paths.cost[static_cast<std::size_t>(farthest)])
        farthest = static_cast<int>(k);
    if (result != nullptr)
      *result = std::move(paths.cost);
    return farthest;
  }

  void growTree(int root)
  {
    std::vector<double> along;
    farthestFrom(root, &along);
    const Paths centred = shortestPaths(spheres_, neighbours_, {{0.0, root}},
                                        [this](int a, int b)
                                        {
                                          const double narrow = std::min(at(a).radius, at(b).radius);
                                          return length(a, b) / (narrow * narrow);
                                        });
    std::vector<int> order;
    for (std::size_t k = 0; k < spheres_.size(); ++k)
      if (may_be_tip_[k] && along[k] < kUnreached)
        order.push_back(static_cast<int>(k));
    std::stable_sort(order.begin(), order.end(),
                     [&along](int a, int b)
                     { return along[static_cast<std::size_t>(a)] > along[static_cast<std::size_t>(b)]; });
    in_tree_.assign(spheres_.size(), false);
    in_tree_[static_cast<std::size_t>(root)] = true;
    for (int tip : order)
      if (!covered_[static_cast<std::size_t>(tip)])
        addBranch(tip, centred.previous);
  }

  /** Traces the minimal path from a tip to the tree. A sufficiently long path becomes a branch and covers its
   *  surroundings; otherwise only the tip is covered. */
  void addBranch(int tip, const std::vector<int>& previous)
  {
    std::vector<int> path{tip};
    double outside = 0.0;
    double widest_outside = at(tip).radius;
    while (!in_tree_[static_cast<std::size_t>(path.back())])
    {
      const int next = previous[static_cast<std::size_t>(path.back())];
      if (!covered_[static_cast<std::size_t>(path.back())])
      {
        outside += length(path.back(), next);
        widest_outside = std::max(widest_outside, at(path.back()).radius);
      }
      path.push_back(next);
    }
    if (outside < kShortestBranch * widest_outside)
    {
      covered_[static_cast<std::size_t>(tip)] = true;
      return;
    }
    std::vector<std::pair<double, int>> sources;
    for (std::size_t k = 0; k < path.size(); ++k)
    {
      sources.emplace_back(-kCover * at(path[k]).radius, path[k]);
      in_tree_[static_cast<std::size_t>(path[k])] = true;
      if (k > 0)
        link(path[k - 1], path[k]);
    }
    const Paths around = lengths(sources, 0.0);
    for (std::size_t k = 0; k < spheres_.size(); ++k)
      if (around.cost[k] <= 0.0)
        covered_[k] = true;
  }

  void link(int a, int b)
  {
    tree_[static_cast<std::size_t>(a)].push_back(b);
    tree_[static_cast<std::size_t>(b)].push_back(a);
  }

  /** End with the largest radius among its first spheres. */
  int widestEnd() const
  {
    int widest = -1;
    double widest_radius = -1.0;
    for (std::size_t k = 0; k < tree_.size(); ++k)
    {
      if (tree_[k].size() != 1)
        continue;
      double radius = at(static_cast<int>(k)).radius;
      int from = static_cast<int>(k);
      int sphere = tree_[k].front();
      for (int step = 0; step < 4; ++step)
      {
        radius = std::max(radius, at(sphere).radius);
        const std::vector<int>& next = tree_[static_cast<std::size_t>(sphere)];
        if (next.size() != 2)
          break;
        const int onward = next[0] == from ? next[1] : next[0];
        from = sphere;
        sphere = onward;
      }
      if (radius > widest_radius)
      {
        widest_radius = radius;
        widest = static_cast<int>(k);
      }
    }
    return widest;
  }

  std::vector<SkeletonBranch> branchesFrom(int root) const
  {
    std::vector<SkeletonBranch> branches;
    if (root < 0)
      return branches;
    struct Start
    {
      int parent;
      int from;
      int to;
    };
    std::queue<Start> open;
    open.push({-1, root, tree_[static_cast<std::size_t>(root)].front()});
    for (; !open.empty(); open.pop())
    {
      SkeletonBranch branch{open.front().parent, {open.front().from, open.front().to}};
      while (tree_[static_cast<std::size_t>(branch.spheres.back())].size() == 2)
      {
        const std::vector<int>& next = tree_[static_cast<std::size_t>(branch.spheres.back())];
        branch.spheres.push_back(next[0] == branch.spheres[branch.spheres.size() - 2] ? next[1] : next[0]);
      }
      const int fork = branch.spheres.back();
      const int came_from = branch.spheres[branch.spheres.size() - 2];
      const int index = static_cast<int>(branches.size());
      branches.push_back(std::move(branch));
      for (int next : tree_[static_cast<std::size_t>(fork)])
        if (next != came_from)
          open.push({index, fork, next});
    }
    return branches;
  }

  const std::vector<MedialSphere>& spheres_;
  const Graph& neighbours_;
  std::vector<bool> may_be_tip_;
  std::vector<bool> covered_;
  std::vector<bool> in_tree_;
  Graph tree_;
};

}  // namespace

std::vector<SkeletonBranch> medialSkeleton(const std::vector<MedialSphere>& spheres,
                                           const std::vector<std::vector<int>>& neighbours)
{
  return spheres.empty() ? std::vector<SkeletonBranch>() : Skeletoniser(spheres, neighbours).run();
}

}  // namespace endovascular_sim::vessel
