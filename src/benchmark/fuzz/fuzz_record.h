#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "benchmark/fuzz/leak_fuzz.h"

namespace endovascular_sim::benchmark
{

/** Results of a leak fuzz, from which it can be resumed. */
class FuzzRecord
{
public:
  FuzzRecord(FuzzSettings settings, std::vector<std::string> kinds);

  void add(const FuzzEpisode& episode);

  std::uint64_t nextEpisode() const { return next_; }
  std::uint64_t steps() const { return steps_; }
  std::uint64_t escapes() const { return escapes_; }
  std::uint64_t notFinite() const { return not_finite_; }
  double depth() const { return worst_.empty() ? 0.0 : worst_.front().depth; }  ///< largest penetration depth [m]

  /** No escape, no NaN, no depth beyond kFuzzDepth, no force beyond kFuzzOverGrips. */
  bool good() const { return escapes_ == 0 && not_finite_ == 0 && too_deep_ == 0 && too_strong_ == 0; }

  /** Results as JSON; also the state for resume(). */
  std::string json() const;

  /** Restores the state of an earlier json().
   *  @param origin name of the text's source, for messages
   *  @throws InputError for damaged text, or another seed, episode length, overrides or list of vessels */
  void resume(const std::string& json, const std::string& origin);

  std::string csv() const;  ///< worst episodes as CSV

  /** Short report.
   *  @param command command that reproduces an episode, without its number
   *  @param skipped files that were not used, with the reason */
  std::string markdown(const std::string& command, const std::vector<std::string>& skipped) const;

private:
  /** Totals over all episodes in one vessel. */
  struct VesselTotal
  {
    std::uint64_t episodes = 0;
    std::uint64_t steps = 0;
    std::uint64_t escapes = 0;
    double depth = 0.0;  ///< largest penetration depth [m]
  };

  bool isWorse(const FuzzEpisode& a, const FuzzEpisode& b) const;

  FuzzSettings settings_;
  std::vector<std::string> kinds_;
  std::uint64_t next_ = 0, steps_ = 0, checks_ = 0, escapes_ = 0, not_finite_ = 0, too_deep_ = 0, too_strong_ = 0;
  double over_grips_ = 0.0;  ///< largest force on a hand relative to the sum of the grips
  std::uint64_t rejected_ = 0, hit_iteration_limit_ = 0;
  std::map<std::string, VesselTotal> vessels_;
  std::vector<FuzzEpisode> worst_;  ///< sorted, worst first
};

}  // namespace endovascular_sim::benchmark
