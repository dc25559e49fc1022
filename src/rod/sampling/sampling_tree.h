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

/** How finely a wire is cut where it bends. */
struct SamplingSettings
{
  double min_edge = 0.5e-3;     ///< an edge this long or shorter is not split for its curvature [m]
  double max_edge = 2.0e-3;     ///< no edge is longer [m]
  double turn_per_edge = 0.05;  ///< η: an edge that turns by more is split [rad]
  double merge_fraction = 0.7;  ///< of η, below which the turn of both halves together must be to merge them
  int min_age = 10;             ///< updates that both halves must have lived
  int extra_levels = 0;         ///< levels below that of min_edge, for where they are demanded
};

/** An edge of the wire: 2^level base edges, beginning at a multiple of its own length. */
struct SamplingLeaf
{
  std::int64_t begin = 0;  ///< arc length from the proximal end, in base edges
  int level = 0;
  int age = 0;  ///< updates since it was made

  std::int64_t end() const { return begin + (std::int64_t{1} << level); }
};

/** What the wire asks of the sampling at one leaf. */
struct SamplingDemand
{
  double curvature = 0.0;  ///< to be resolved [1/m]
  int coarsest = 0;        ///< level above which the leaf is split, whatever its curvature
  int min_age = 0;         ///< updates that it must have lived before it is merged
};

/** As the age that a leaf must have: it is never merged. */
constexpr int kNeverMerged = std::numeric_limits<int>::max();

/** Edges of a wire as the leaves of a forest of binary trees: an edge is halved, or joined with its other half again,
 *  so that a merge is exactly the inverse of a split. Neighbours differ by one level at most. Equal roots fill the
 *  wire's length, none longer than max_edge; the finest level is the first at which an edge is no longer than
 *  min_edge, or so many levels below as the settings say. */
class SamplingTree
{
public:
  /** All leaves at the coarsest level.
   *  @param length of the wire [m], positive */
  SamplingTree(double length, const SamplingSettings& settings);

  int coarsestLevel() const { return coarsest_; }
  int fineLevel() const { return settings_.extra_levels; }  ///< the coarsest with edges no longer than min_edge
  double edge(int level) const { return base_edge_ * static_cast<double>(std::int64_t{1} << level); }  ///< [m]
  const std::vector<SamplingLeaf>& leaves() const { return leaves_; }
  int nodes() const { return static_cast<int>(leaves_.size()) + 1; }

  /** Arc length of a leaf's boundary [m]; the same boundary gives the same bits whatever lies around it. */
  double position(std::int64_t base_edges) const;

  /** Arc lengths of all nodes [m]. */
  void positions(std::vector<double>& position) const;

  /** One round of splits and merges, each by one level. Ages grow by one.
   *  @param demand per leaf
   *  @return whether any leaf changed */
  bool update(const std::vector<SamplingDemand>& demand);

  /** Saves the leaves, or loads those of a tree of the same wire. */
  void archive(Archive& archive);

private:
  enum class Change : char
  {
    kNone,
    kSplit,
    kMerge,  ///< with the next leaf
  };

  void markSplits(const std::vector<SamplingDemand>& demand);
  void markMerges(const std::vector<SamplingDemand>& demand);
  bool canMerge(std::size_t leaf, const std::vector<SamplingDemand>& demand) const;
  int levelAfterSplits(std::size_t leaf) const { return leaves_[leaf].level - (change_[leaf] == Change::kSplit); }
  void rebuild();

  SamplingSettings settings_;
  double length_;
  double base_edge_;
  std::int64_t base_edges_;
  int coarsest_;
  std::vector<SamplingLeaf> leaves_, next_;
  std::vector<Change> change_;
};

}  // namespace endovascular_sim::rod
