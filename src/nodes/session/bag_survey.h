#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "endovascular_sim/SessionGap.h"
#include "endovascular_sim/SessionInfo.h"

namespace endovascular_sim::nodes
{

/** Steps that a bag lacks between its first and its last one. */
struct StepGap
{
  std::uint64_t first = 0, last = 0;
};

/** Topic of a bag. */
struct BagTopic
{
  std::string type, md5sum;
  std::uint64_t messages = 0;
  bool is_latched = false;
  bool is_of_other_version = false;  ///< true: this version has other fields for its type
};

/** Content of a bag, and what can be done with it. */
struct BagSurvey
{
  std::string file;
  std::uint64_t bytes = 0;
  std::string refusal;  ///< reason for which the file cannot be read as a bag; empty if it can
  std::string damage;   ///< first damage; empty without one
  std::optional<SessionInfo> info;
  std::map<std::string, BagTopic> topics;  ///< by present name
  std::uint64_t steps = 0;                 ///< number of different steps
  std::uint64_t first_step = 0, last_step = 0;
  std::uint64_t repeated_steps = 0;             ///< steps that stand more than once
  std::uint64_t disordered_steps = 0;           ///< steps that stand behind a later one
  std::optional<std::uint64_t> recorded_steps;  ///< by session/end; empty: the bag has no end
  std::vector<StepGap> gaps;
  std::vector<SessionGap> outer_gaps;  ///< before and behind the bag, where its recording was interrupted
  std::uint64_t marks = 0;             ///< number of remarks of a teacher
  std::uint64_t state_bytes = 0;  ///< of the saved state from which the recording continues; 0: the scene's beginning

  bool shows = false;                          ///< replay.launch shows the session
  bool reports = false;                        ///< reports can be made without a computation
  std::optional<std::uint64_t> recomputed_to;  ///< last step up to which `replay` can compute the session again
  std::string obstacle;                        ///< reason for which it computes not every step; empty without one

  bool isComplete() const { return shows && reports && recomputed_to && obstacle.empty(); }
  bool isUsable() const { return shows || reports || recomputed_to; }
};

/** Examines a bag without its index. Damages and other versions are described, not thrown.
 *  @param computes true: also makes scene and vessel of the bag, as a replay would */
BagSurvey surveyBag(const std::string& file, bool computes = true);

/** Writes the readable messages of a bag into another one, with an index.
 *  @return number of messages
 *  @throws InputError when the bag cannot be read, or the copy not be written */
std::uint64_t repairBag(const std::string& file, const std::string& copy);

nlohmann::ordered_json toJson(const BagSurvey& survey);

/** Survey in some lines, for a person. */
std::string textOf(const BagSurvey& survey);

}  // namespace endovascular_sim::nodes
