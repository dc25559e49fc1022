#include "rod/sampling/sampling_tree.h"

#include <algorithm>
#include <cmath>

#include "common/archive.h"
#include "common/archive_checks.h"

namespace endovascular_sim::rod
{
namespace
{

constexpr double kSameLength = 1e-9;  // relative difference below which lengths count as equal
constexpr int kDeepest = 20;
constexpr int kOld = 1 << 20;  // age of the initial leaves

}  // namespace

SamplingTree::SamplingTree(double length, const SamplingSettings& settings) : settings_(settings), length_(length)
{
  const double roots = std::max(1.0, std::ceil(length / settings.max_edge * (1.0 - kSameLength)));
  const double bisections = std::ceil(std::log2(length / roots / settings.min_edge) - kSameLength);
  coarsest_ = settings.extra_levels + std::max(0, std::min(kDeepest, static_cast<int>(bisections)));
  base_edges_ = static_cast<std::int64_t>(roots) << coarsest_;
  base_edge_ = length / static_cast<double>(base_edges_);
  for (std::int64_t begin = 0; begin < base_edges_; begin += std::int64_t{1} << coarsest_)
    leaves_.push_back({begin, coarsest_, kOld});
}

double SamplingTree::position(std::int64_t base_edges) const
{
  return length_ * (static_cast<double>(base_edges) / static_cast<double>(base_edges_));
}

void SamplingTree::positions(std::vector<double>& position) const
{
  position.resize(leaves_.size() + 1);
  for (std::size_t j = 0; j < leaves_.size(); ++j)
    position[j] = this->position(leaves_[j].begin);
  position.back() = length_;
}

bool SamplingTree::update(const std::vector<SamplingDemand>& demand)
{
  change_.assign(leaves_.size(), Change::kNone);
  for (SamplingLeaf& leaf : leaves_)
    leaf.age = std::min(leaf.age + 1, kOld);
  markSplits(demand);
  markMerges(demand);
  if (std::all_of(change_.begin(), change_.end(), [](Change change) { return change == Change::kNone; }))
    return false;
  rebuild();
  return true;
}

void SamplingTree::markSplits(const std::vector<SamplingDemand>& demand)
{
  for (std::size_t j = 0; j < leaves_.size(); ++j)
  {
    const SamplingLeaf& leaf = leaves_[j];
    const double turn = demand[j].curvature * edge(leaf.level);
    const bool curved = leaf.level > fineLevel() && turn > settings_.turn_per_edge;
    if (leaf.level > 0 && (curved || leaf.level > demand[j].coarsest))
      change_[j] = Change::kSplit;
  }
  // A neighbour that would be two levels coarser than a split leaf is split too, and so on outwards.
  const auto balance = [this](std::size_t j, std::size_t neighbour)
  {
    if (change_[j] == Change::kNone && leaves_[j].level > levelAfterSplits(neighbour) + 1)
      change_[j] = Change::kSplit;
  };
  for (std::size_t j = 1; j < leaves_.size(); ++j)
    balance(j, j - 1);
  for (std::size_t j = leaves_.size() - 1; j-- > 0;)
    balance(j, j + 1);
}

bool SamplingTree::canMerge(std::size_t j, const std::vector<SamplingDemand>& demand) const
{
  const SamplingLeaf& a = leaves_[j];
  const SamplingLeaf& b = leaves_[j + 1];
  const bool siblings = a.level == b.level && ((a.begin >> a.level) & 1) == 0;
  if (!siblings || a.level >= coarsest_ || change_[j] != Change::kNone || change_[j + 1] != Change::kNone)
    return false;
  if (a.age < demand[j].min_age || b.age < demand[j + 1].min_age)
    return false;
  if (a.level + 1 > std::min(demand[j].coarsest, demand[j + 1].coarsest))
    return false;
  const double turn = std::max(demand[j].curvature, demand[j + 1].curvature) * edge(a.level + 1);
  if (a.level >= fineLevel() && turn >= settings_.merge_fraction * settings_.turn_per_edge)
    return false;
  return (j == 0 || levelAfterSplits(j - 1) >= a.level) &&
         (j + 2 == leaves_.size() || levelAfterSplits(j + 2) >= a.level);
}

void SamplingTree::markMerges(const std::vector<SamplingDemand>& demand)
{
  for (std::size_t j = 0; j + 1 < leaves_.size(); ++j)
    if (canMerge(j, demand))
      change_[j++] = Change::kMerge;
}

void SamplingTree::rebuild()
{
  next_.clear();
  for (std::size_t j = 0; j < leaves_.size(); ++j)
  {
    const SamplingLeaf& leaf = leaves_[j];
    switch (change_[j])
    {
      case Change::kNone:
        next_.push_back(leaf);
        break;
      case Change::kSplit:
        next_.push_back({leaf.begin, leaf.level - 1, 0});
        next_.push_back({leaf.begin + (std::int64_t{1} << (leaf.level - 1)), leaf.level - 1, 0});
        break;
      case Change::kMerge:
        next_.push_back({leaf.begin, leaf.level + 1, 0});
        ++j;
        break;
    }
  }
  leaves_.swap(next_);
}

void archive(Archive& archive, SamplingLeaf& leaf)
{
  archive(leaf.begin, leaf.level, leaf.age);
}

void SamplingTree::archive(Archive& archive)
{
  archive(leaves_);
  if (archive.reading())
    requireFit();
}

/** Checks that the leaves follow each other along the whole wire, each at a multiple of its length. */
void SamplingTree::requireFit() const
{
  std::int64_t end = 0;
  for (const SamplingLeaf& leaf : leaves_)
  {
    requireIndex(leaf.level, 0, coarsest_ + 1);
    requireIndex(leaf.age, 0, kOld + 1);
    requireLoaded(leaf.begin == end && leaf.begin % (std::int64_t{1} << leaf.level) == 0,
                  "holds edges that do not fill the wire");
    end = leaf.end();
  }
  requireLoaded(end == base_edges_, "holds edges that do not fill the wire");
}

}  // namespace endovascular_sim::rod
