#pragma once

#include <cstdint>
#include <limits>
#include <vector>

namespace endovascular_sim
{
class Archive;
}

namespace endovascular_sim::rod
{

/** Settings of adaptive sampling. */
struct SamplingSettings
{
  double min_edge = 0.5e-3;     ///< least length of an edge that is split for its curvature, exclusive [m]
  double max_edge = 2.0e-3;     ///< largest length of an edge [m]
  double turn_per_edge = 0.05;  ///< η, turning angle of an edge beyond which it is split [rad]
  double merge_fraction = 0.7;  ///< turning angle of a merged edge below which it is merged, relative to η
  int min_age = 10;             ///< least age of both halves for a merge, in updates
  int extra_levels = 0;         ///< levels below that of min_edge, where they are demanded
};

/** Edge of the wire: 2^level base edges, beginning at a multiple of its own length. */
struct SamplingLeaf
{
  std::int64_t begin = 0;  ///< arc length from the proximal end, in base edges
  int level = 0;
  int age = 0;  ///< updates since its split or merge

  std::int64_t end() const { return begin + (std::int64_t{1} << level); }
};

/** Demand on the sampling at one leaf. */
struct SamplingDemand
{
  double curvature = 0.0;  ///< curvature to be resolved [1/m]
  int coarsest = 0;        ///< level above which the leaf is split, whatever its curvature
  int min_age = 0;         ///< least age for a merge, in updates
};

/** Least age of a leaf that is never merged. */
constexpr int kNeverMerged = std::numeric_limits<int>::max();

/** Edges of a wire as the leaves of a forest of binary trees. An edge is split into halves, or merged with its other
 *  half, so that a merge is exactly the inverse of a split. Neighbours differ by one level at most. Equal roots, none
 *  longer than max_edge, fill the wire's length. The finest level is the first at which an edge is no longer than
 *  min_edge, and SamplingSettings::extra_levels below. */
class SamplingTree
{
public:
  /** All leaves at the coarsest level.
   *  @param length of the wire [m], positive */
  SamplingTree(double length, const SamplingSettings& settings);

  int coarsestLevel() const { return coarsest_; }
  int fineLevel() const { return settings_.extra_levels; }  ///< coarsest level with edges no longer than min_edge
  /** Length of an edge [m]. */
  double edge(int level) const { return base_edge_ * static_cast<double>(std::int64_t{1} << level); }
  const std::vector<SamplingLeaf>& leaves() const { return leaves_; }
  int nodes() const { return static_cast<int>(leaves_.size()) + 1; }

  /** Arc length of a leaf's boundary [m]; its bits do not depend on the other leaves. */
  double position(std::int64_t base_edges) const;

  /** Arc lengths of all nodes [m]. */
  void positions(std::vector<double>& position) const;

  /** Splits and merges leaves, each by one level. Ages grow by one.
   *  @param demand per leaf
   *  @return true when any leaf changed */
  bool update(const std::vector<SamplingDemand>& demand);

  /** Saves the leaves, or loads those of a tree of the same wire.
   *  @throws ArchiveError when they do not fill the wire */
  void archive(Archive& archive);

private:
  enum class Change : char
  {
    kNone,
    kSplit,
    kMerge,  ///< merge with the next leaf
  };

  void markSplits(const std::vector<SamplingDemand>& demand);
  void markMerges(const std::vector<SamplingDemand>& demand);
  bool canMerge(std::size_t leaf, const std::vector<SamplingDemand>& demand) const;
  int levelAfterSplits(std::size_t leaf) const { return leaves_[leaf].level - (change_[leaf] == Change::kSplit); }
  void rebuild();
  void requireFit() const;

  SamplingSettings settings_;
  double length_;
  double base_edge_;
  std::int64_t base_edges_;
  int coarsest_;
  std::vector<SamplingLeaf> leaves_, next_;
  std::vector<Change> change_;
};

}  // namespace endovascular_sim::rod
