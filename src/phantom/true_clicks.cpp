#include "phantom/true_clicks.h"

#include <algorithm>
#include <set>

#include "common/error.h"
#include "common/numerics/counter_noise.h"

namespace endovascular_sim::phantom
{
namespace
{

constexpr double kOffAxis = 0.35;        ///< offset of a click, in radii
constexpr double kShortest = 0.015;      ///< shortest part of a branch in the field of view [m]
constexpr double kDistal = 0.9;          ///< share of a free branch at its last click
constexpr double kAfterOstium = 1.0e-3;  ///< least distance of the first click from the parent's lumen [m]

/** Samples of a chain that belong to one branch and lie in the field of view: the longest run. */
struct Run
{
  std::size_t begin = 0;
  std::size_t end = 0;
};

Run longestRun(const vessel::AnatomyChain& chain, std::size_t first, std::size_t last, const Eigen::AlignedBox3d& view)
{
  Run best;
  Run run{first, first};
  for (std::size_t k = first; k < last; ++k)
  {
    const Eigen::Vector3d reach = Eigen::Vector3d::Constant(chain.radii[k]);
    const bool inside = view.contains(chain.points[k] - reach) && view.contains(chain.points[k] + reach);
    if (!inside)
      run = {k + 1, k + 1};
    else
      run.end = k + 1;
    if (run.end - run.begin > best.end - best.begin)
      best = run;
  }
  return best;
}

/** Distance of a point from the lumen of a chain and from all bulges [m]; negative inside. */
double fromLumen(const vessel::Anatomy& anatomy, const vessel::AnatomyChain& chain, const Eigen::Vector3d& p)
{
  double least = 1e300;
  for (const vessel::Bulge& bulge : anatomy.bulges)
    least = std::min(least, (p - bulge.centre).norm() - bulge.radius);
  for (std::size_t k = 0; k < chain.points.size(); ++k)
    least = std::min(least, (p - chain.points[k]).norm() - chain.radii[k]);
  return least;
}

Eigen::Vector3d click(const vessel::AnatomyChain& chain, std::size_t k, std::uint64_t seed, std::uint64_t number)
{
  float a[2];
  float b[2];
  CounterNoise(seed, 0x636c69636bULL + number).fill(0, 2, a, b);
  const Eigen::Vector3d direction(a[0], b[0], a[1]);
  return chain.points[k] + kOffAxis * chain.radii[k] * direction.normalized();
}

}  // namespace

std::vector<BranchClicks> trueClicks(const vessel::Anatomy& anatomy, const std::vector<std::string>& names,
                                     const Eigen::AlignedBox3d& view, std::uint64_t seed)
{
  const std::vector<vessel::AnatomyChain> chains = vessel::sampleChains(anatomy);
  const auto chainOf = [&chains](int branch)
  {
    return std::find_if(
        chains.begin(), chains.end(),
        [branch](const vessel::AnatomyChain& chain)
        { return std::find(chain.branches.begin(), chain.branches.end(), branch) != chain.branches.end(); });
  };
  for (const std::string& name : names)
    if (std::none_of(anatomy.branches.begin(), anatomy.branches.end(),
                     [&name](const vessel::AnatomyBranch& branch) { return branch.name == name; }))
      throw InputError(anatomy.file, name, "is no branch of this anatomy");
  std::vector<BranchClicks> clicks;
  std::set<int> with_clicks;
  std::set<int> parents;
  for (const vessel::AnatomyChain& chain : chains)
  {
    // Without names: one tree, not a branch whose parent is out of view.
    if (names.empty() && !clicks.empty() && with_clicks.count(chain.parent) + parents.count(chain.parent) == 0)
      continue;
    for (std::size_t b = 0; b < chain.branches.size(); ++b)
    {
      const std::string& name = anatomy.branches[static_cast<std::size_t>(chain.branches[b])].name;
      if (!names.empty() && std::find(names.begin(), names.end(), name) == names.end())
        continue;
      const std::size_t last = b + 1 < chain.branches.size() ? chain.first_sample[b + 1] : chain.points.size();
      Run run = longestRun(chain, chain.first_sample[b], last, view);
      if (b == 0 && chain.parent >= 0)  // begins in the lumen of the parent
        while (run.begin + 1 < run.end &&
               fromLumen(anatomy, *chainOf(chain.parent), chain.points[run.begin]) < kAfterOstium)
          ++run.begin;
      const double length = run.end > run.begin ? chain.arc[run.end - 1] - chain.arc[run.begin] : 0.0;
      if (length < kShortest)
      {
        if (!names.empty())
          throw InputError(anatomy.file, name, "has less than 15 mm in the field of view; choose a larger one");
        continue;
      }
      std::size_t end = run.begin;
      while (end + 1 < run.end && chain.arc[end] - chain.arc[run.begin] < kDistal * length)
        ++end;
      const auto branch = static_cast<std::uint64_t>(chain.branches[b]);
      with_clicks.insert(chain.branches[b]);
      parents.insert(chain.parent);
      clicks.push_back({name, {click(chain, run.begin, seed, 2 * branch), click(chain, end, seed, 2 * branch + 1)}});
    }
  }
  return clicks;
}

}  // namespace endovascular_sim::phantom
