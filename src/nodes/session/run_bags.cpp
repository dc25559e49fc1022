#include "nodes/session/run_bags.h"

#include <algorithm>
#include <filesystem>
#include <system_error>
#include <utility>

#include <rosbag/bag.h>

#include "common/error.h"
#include "endovascular_sim/DriveApplied.h"
#include "endovascular_sim/SessionEnd.h"
#include "nodes/runtime/ros_names.h"
#include "nodes/session/bag_records.h"
#include "nodes/session/bag_survey.h"
#include "nodes/session/bag_writer.h"
#include "nodes/session/session_bag.h"

namespace endovascular_sim::nodes
{

RunBags::RunBags(std::string folder) : folder_(std::move(folder))
{
  while (std::filesystem::exists(folder_ + "/" + nextName()))
    names_.push_back(nextName());
  for (auto name = names_.rbegin(); name != names_.rend() && last_name_.empty(); ++name)
    examine(*name);
}

std::string RunBags::nameOf(std::size_t number)
{
  return number == 1 ? "session.bag" : "session_" + std::to_string(number) + ".bag";
}

/** Finds the last step of a bag. A file that is no bag, and one without a step, count as none. */
void RunBags::examine(const std::string& name)
{
  std::uint64_t steps = 0;
  bool has_end = false;
  const auto visit = [&](const BagMessage& message)
  {
    if (isTopic(message.topic, names::kSessionEnd))
      has_end = true;
    if (isTopic(message.topic, names::kDriveApplied) && message.is<DriveApplied>())
      steps = std::max(steps, message.read<DriveApplied>()->step + 1);
  };
  try
  {
    const std::string damage = readBagMessages(folder_ + "/" + name, visit);
    if (steps == 0)
      return;
    last_name_ = name;
    steps_ = steps;
    has_end_ = has_end;
    damage_ = damage;
  }
  catch (const std::exception&)  // no bag, or with bytes that are no message
  {
  }
}

void RunBags::complete(const std::string& prefix, const SessionGap* gap) const
{
  const std::string file = folder_ + "/" + last_name_;
  try
  {
    if (!damage_.empty())
    {
      const std::string copy = file + ".repaired";
      repairBag(file, copy);
      std::filesystem::rename(copy, file);
    }
    if (gap == nullptr && has_end_)
      return;
    rosbag::Bag bag(file, rosbag::bagmode::Append);
    bag.setCompression(rosbag::compression::LZ4);
    const ros::Time now = std::max(ros::Time::now(), ros::TIME_MIN);
    if (gap != nullptr)
      bag.write(prefix + names::kSessionGap, now, *gap, BagWriter::latchedHeader<SessionGap>());
    SessionEnd end;
    end.header.stamp = now;
    end.steps = steps_;
    if (!has_end_)
      bag.write(prefix + names::kSessionEnd, now, end, BagWriter::latchedHeader<SessionEnd>());
    bag.close();
  }
  catch (const rosbag::BagException& error)
  {
    throw InputError(file, "", std::string("cannot be completed (") + error.what() + "); free some space on its disk");
  }
  catch (const std::filesystem::filesystem_error& error)
  {
    throw InputError(
        file, "", "cannot be replaced by its repaired copy (" + error.code().message() + "); make its folder writable");
  }
}

}  // namespace endovascular_sim::nodes
