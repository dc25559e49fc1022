#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

namespace endovascular_sim::results
{

/** Remark of a teacher on a session. */
struct Remark
{
  std::uint64_t step = 0;  ///< number of steps when it was made
  double time = 0.0;       ///< simulated time [s]
  std::string text;
};

/** Steps of a session that no bag holds. */
struct RecordingGap
{
  std::uint64_t first_step = 0, last_step = 0;
  std::string previous, next;  ///< names of the bags before and after it; the first may be empty
};

/** What a recording holds beside the motion. */
struct RecordingNotes
{
  std::vector<Remark> remarks;
  std::vector<RecordingGap> gaps;
};

nlohmann::ordered_json toJson(const std::vector<Remark>& remarks);
nlohmann::ordered_json toJson(const std::vector<RecordingGap>& gaps);

}  // namespace endovascular_sim::results
