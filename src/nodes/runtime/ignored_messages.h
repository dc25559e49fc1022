#pragma once

#include <cstdint>
#include <map>
#include <mutex>
#include <string>

#include <diagnostic_updater/diagnostic_updater.h>
#include <ros/console.h>

namespace endovascular_sim::nodes
{

/** Invalid messages that this process has ignored, by topic. Callable from any thread. */
class IgnoredMessages
{
public:
  /** Those of this process. */
  static IgnoredMessages& ofProcess()
  {
    static IgnoredMessages messages;
    return messages;
  }

  /** Counts a message. The first one of each topic is logged. */
  void add(const std::string& topic, const std::string& reason)
  {
    bool is_first = false;
    {
      const std::lock_guard<std::mutex> lock(mutex_);
      Record& record = records_[topic];
      is_first = record.count == 0;
      ++record.count;
      record.reason = reason;
    }
    if (is_first)
      ROS_WARN("an invalid message on %s is ignored, as are further ones: %s", topic.c_str(), reason.c_str());
  }

  std::uint64_t count() const
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    std::uint64_t count = 0;
    for (const auto& [topic, record] : records_)
      count += record.count;
    return count;
  }

  /** Adds numbers and last reasons to the diagnostics. Messages since the last call are a warning. */
  void diagnose(diagnostic_updater::DiagnosticStatusWrapper& status)
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    for (auto& [topic, record] : records_)
    {
      if (record.count != record.diagnosed)
        status.mergeSummary(diagnostic_msgs::DiagnosticStatus::WARN, "invalid messages on " + topic + " are ignored");
      record.diagnosed = record.count;
      status.add("ignored messages on " + topic, std::to_string(record.count) + "; last: " + record.reason);
    }
  }

private:
  struct Record
  {
    std::uint64_t count = 0;
    std::uint64_t diagnosed = 0;  ///< count at the last diagnosis
    std::string reason;           ///< of the last one
  };

  mutable std::mutex mutex_;
  std::map<std::string, Record> records_;
};

}  // namespace endovascular_sim::nodes
