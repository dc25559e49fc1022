#include "nodes/session/session_bag.h"

#include <optional>
#include <vector>

#include <rosbag/bag.h>
#include <rosbag/view.h>

#include "common/error.h"
#include "common/version.h"
#include "nodes/runtime/ros_names.h"

namespace endovascular_sim::nodes
{
namespace
{

/** Reports whether a full topic name ends with a name of the graph; scenes may run in any namespace. */
bool isTopic(const std::string& topic, const std::string& name)
{
  return topic.size() > name.size() &&
         topic.compare(topic.size() - name.size() - 1, std::string::npos, "/" + name) == 0;
}

/** Session info of another version. New fields are appended to the message only: the known ones are at its beginning.
 */
SessionInfo infoOfOtherVersion(const rosbag::MessageInstance& message)
{
  std::vector<std::uint8_t> bytes(message.size());
  ros::serialization::OStream out(bytes.data(), static_cast<std::uint32_t>(bytes.size()));
  message.write(out);
  ros::serialization::IStream in(bytes.data(), static_cast<std::uint32_t>(bytes.size()));
  SessionInfo info;
  in.next(info.header);
  in.next(info.scene_name);
  in.next(info.scene_yaml);
  in.next(info.scene_hash);
  in.next(info.mesh_hash);
  in.next(info.seed);
  in.next(info.time_step);
  in.next(info.software_version);
  if (in.getLength() == 0)
    return info;  // recorded before the message had a commit and a physics number
  in.next(info.commit);
  in.next(info.physics_number);
  return info;
}

std::optional<SessionInfo> readInfo(const rosbag::Bag& bag)
{
  rosbag::View view(
      bag, [](const rosbag::ConnectionInfo* connection) { return isTopic(connection->topic, names::kSessionInfo); });
  std::optional<SessionInfo> info;
  for (const rosbag::MessageInstance& message : view)
  {
    const auto current = message.instantiate<SessionInfo>();
    info = current ? *current : infoOfOtherVersion(message);
  }
  return info;
}

void requireSamePhysics(const std::string& file, const SessionInfo& info)
{
  if (info.physics_number == kPhysicsNumber)
    return;
  const std::string here = "; this program has physics " + std::to_string(kPhysicsNumber) + " (version " + version() +
                           ", commit " + commit() + ")";
  if (info.physics_number == 0)
    throw InputError(file, names::kSessionInfo,
                     "holds no physics number: version " + info.software_version + " recorded it" + here +
                         "; replay it with version " + info.software_version +
                         ", at the commit from which it was recorded");
  throw InputError(file, names::kSessionInfo,
                   "has physics " + std::to_string(info.physics_number) + ", recorded by version " +
                       info.software_version + ", commit " + info.commit + here +
                       "; replay it with a build of commit " + info.commit);
}

}  // namespace

SessionBag readSessionBag(const std::string& file)
{
  rosbag::Bag bag;
  bag.open(file, rosbag::bagmode::Read);
  const std::optional<SessionInfo> info = readInfo(bag);
  if (!info)
    throw InputError(file, names::kSessionInfo, "missing; only bags of the session node can be replayed");
  requireSamePhysics(file, *info);
  SessionBag session;
  session.info = *info;
  for (const rosbag::MessageInstance& message : rosbag::View(bag))
  {
    if (isTopic(message.getTopic(), names::kDriveApplied))
    {
      const auto applied = message.instantiate<DriveApplied>();
      if (!applied)
        throw InputError(file, names::kDriveApplied,
                         "has the fields of another version; replay it with a build of commit " + info->commit);
      session.steps[applied->step] = applied;
    }
    else if (isTopic(message.getTopic(), names::kVesselMesh) && !session.mesh)
      session.mesh = message.instantiate<VesselMesh>();
    else if (isTopic(message.getTopic(), names::kVesselCentreline))
      session.centreline = message.instantiate<VesselCentreline>();
  }
  if (session.steps.empty())
    throw InputError(file, names::kDriveApplied, "holds no step");
  return session;
}

}  // namespace endovascular_sim::nodes
