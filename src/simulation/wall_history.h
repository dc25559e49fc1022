#pragma once

#include <cstdint>
#include <deque>
#include <utility>

#include "common/archive.h"

namespace endovascular_sim::simulation
{

/** Interval of the balloon loads on the wall [steps]. Contact detection adopts the wall displacement of a load one
 *  interval later, so the wall has that long to respond. */
constexpr std::uint64_t kBalloonLoadPeriod = 8;

/** Largest lag of the wall of contact detection behind the newest version [versions]: the version that the last load
 *  announced, and the one before it until the next interval begins. */
constexpr std::size_t kWallLag = 2;

/** Most vertices that one balloon load displaces [1]: bounds the time in which contact detection adopts them. */
constexpr std::size_t kMostDisplacedVertices = 200;

/** Versions of a wall that moves: the version that a reader's mesh has, and the displacements that lead from it to the
 *  newest version, in order. Versions count up by one.
 *  @tparam Displacement intervention::WallDisplacement, or its message */
template <typename Displacement>
class WallHistory
{
public:
  /** Displacement and the version of the wall that it leads to. */
  struct Version
  {
    std::uint64_t version = 0;
    Displacement displacement;

    void archive(Archive& archive) { archive(version, displacement); }
  };

  std::uint64_t newest() const { return newest_; }  ///< version after all displacements
  std::uint64_t base() const { return base_; }      ///< version of the reader's mesh

  /** Appends the displacement that leads to the next version. @return that version */
  std::uint64_t append(Displacement displacement)
  {
    pending_.push_back({++newest_, std::move(displacement)});
    return newest_;
  }

  /** Forgets all displacements and begins with a version. */
  void restartAt(std::uint64_t version)
  {
    newest_ = base_ = version;
    pending_.clear();
  }

  /** Raises the base to a version that was appended.
   *  @param apply called as apply(version, displacement) for every displacement on the way, in order */
  template <typename Apply>
  void advanceTo(std::uint64_t version, Apply apply)
  {
    base_ = version;
    for (; !pending_.empty() && pending_.front().version <= version; pending_.pop_front())
      apply(pending_.front().version, pending_.front().displacement);
  }

  /** Snapshot of the displacements that lead from the base to the newest version, oldest first. */
  const std::deque<Version>& pending() const { return pending_; }

  /** Saves or loads the versions and the pending displacements. */
  void archive(Archive& archive) { archive(newest_, base_, pending_); }

private:
  std::uint64_t newest_ = 1;
  std::uint64_t base_ = 1;
  std::deque<Version> pending_;
};

}  // namespace endovascular_sim::simulation
