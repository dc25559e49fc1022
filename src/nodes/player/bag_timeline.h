#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <ros/time.h>

#include "endovascular_sim/SessionInfo.h"
#include "nodes/session/bag_records.h"

namespace endovascular_sim::nodes
{

/** Origin of the X-ray images of a played recording. */
enum class PlayedImages
{
  kRendered,  ///< the node `fluoroscopy` renders them again from the recorded poses
  kRecorded,  ///< those of the bag
};

/** Use of a topic in a played recording. */
enum class TopicUse
{
  kState,    ///< its last message is part of the shown state
  kEvent,    ///< its messages are played, but not repeated after a jump
  kContent,  ///< read by the player, which publishes what follows from it
};

/** Topic of a recording, with its type in this version. */
struct RecordedTopic
{
  std::string name, type, md5sum, definition;
  bool is_latched = false;
  TopicUse use = TopicUse::kState;
};

/** Place of a message in the bags. */
struct RecordedEntry
{
  ros::Time time;                  ///< of the recording
  std::uint64_t chunk = 0;         ///< as that of BagMessage
  std::uint32_t offset = 0, size;  ///< as those of BagMessage
  std::uint16_t stream = 0;        ///< index of its stream
  std::uint16_t file = 0;          ///< index of its bag
};

/** Messages of which each replaces the one before: those of a topic; on /tf and /tf_static those of the same frames. */
struct RecordedStream
{
  std::size_t topic = 0;               ///< index of its topic
  std::vector<std::uint32_t> entries;  ///< indices of its messages, in the order of their times
};

/** State of the instruments that was recorded. */
struct RecordedState
{
  ros::Time time;          ///< of its `rod/state_visual` in the recording
  ros::Time end;           ///< of the last message that belongs to it, e.g. the balloons of its step
  double simulated = 0.0;  ///< simulated time [s]
  std::uint64_t step = 0;  ///< of the simulation
};

/** Index in memory of the messages of a recorded session: places, not contents. The bags need no index of their own and
 *  may be damaged; what they lack is named. */
class BagTimeline
{
public:
  /** @param files bags of one session in any order: its recording, and those that continue it
   *  @throws InputError when a file is no bag, holds no state that this version can show, or belongs to another run */
  explicit BagTimeline(const std::vector<std::string>& files, PlayedImages images = PlayedImages::kRendered);

  const std::vector<std::string>& files() const { return files_; }  ///< in the order of their steps
  const std::vector<RecordedTopic>& topics() const { return topics_; }
  const std::vector<RecordedStream>& streams() const { return streams_; }
  const std::vector<RecordedEntry>& entries() const { return entries_; }  ///< in the order of their times
  const std::vector<RecordedState>& states() const { return states_; }    ///< not empty, in the order of their times
  const std::optional<SessionInfo>& info() const { return info_; }        ///< of the first bag
  const std::vector<std::string>& missing() const { return missing_; }    ///< what the bags lack, one text each

  /** Topic by its name without the namespace of the graph; null without one. */
  const RecordedTopic* topic(const std::string& name) const;

  /** Entries of the topics with these names, without namespace, in the order of their times. */
  std::vector<std::uint32_t> entriesOf(const std::vector<std::string>& names) const;

  /** Message of an entry, with its bytes as recorded.
   *  @return valid until the next call
   *  @throws InputError when the bag has changed since it was opened */
  const BagMessage& message(std::size_t entry) const;

  /** Index of the last entry of a stream at or before a time of the recording; none before the first one. */
  std::optional<std::size_t> newest(std::size_t stream, ros::Time time) const;

  /** Index of the last state at or before a simulated time [s]; the first one before it. */
  std::size_t stateAtTime(double time) const;
  /** Index of the last state at or before a step; the first one before it. */
  std::size_t stateAtStep(std::uint64_t step) const;
  /** Index of the last state at or before a time of the recording; the first one before it. */
  std::size_t stateAt(ros::Time time) const;

private:
  struct File;

  void index(File& file, PlayedImages images);
  void add(File& file, const BagMessage& message, PlayedImages images);
  std::optional<std::size_t> streamOf(const BagMessage& message, PlayedImages images);
  std::optional<std::size_t> topicOf(const BagMessage& message, PlayedImages images);
  void addState(File& file, const BagMessage& message) const;
  void merge(std::vector<File>& files);
  void completeStates();
  void miss(const std::string& text);

  std::vector<std::string> files_;
  std::vector<RecordedTopic> topics_;
  std::vector<RecordedStream> streams_;
  std::vector<RecordedEntry> entries_;
  std::vector<RecordedState> states_;
  std::optional<SessionInfo> info_;
  std::vector<std::string> missing_;
  std::map<std::string, std::optional<std::size_t>> stream_by_key_, topic_by_name_;
  mutable std::vector<BagMessage> prototypes_;  ///< of each stream, without bytes
  mutable std::vector<BagChunks> chunks_;       ///< of each file
};

}  // namespace endovascular_sim::nodes
